// Runs the Khronos validator on the given files and prints one line of JSON.
// Usage: node validate_gltf.js FILE.glb …, with gltf-validator in the folder that NODE_PATH names.
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
