// Khronos's validator over the files given; prints one line of JSON.
// Usage: node validate_gltf.js FILE.glb …, with gltf-validator where NODE_PATH points.
const fs = require('fs');
const validator = require('gltf-validator');

(async () => {
  const found = [];
  for (const path of process.argv.slice(2)) {
    const { issues, info } = await validator.validateBytes(new Uint8Array(fs.readFileSync(path)));
    found.push({ errors: issues.numErrors, warnings: issues.numWarnings, hints: issues.numHints, info });
  }
  console.log(JSON.stringify(found));
})();
