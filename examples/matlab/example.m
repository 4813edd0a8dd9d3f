% Mass and workspace radius of the paper's designs over the radius of the bars of the legs.
radii = linspace (0.02, 0.06, 5);
designs = arrayfun (@(rj) sprintf ('3-PRR R=3.066 r=1.283 Lb=1.896 rj=%.4f rp=0.056', rj), radii, 'UniformOutput', false);
results = kinefront (designs);
for k = 1:numel (radii)
  line = sprintf ('rj = %.3f m: %.1f kg, R_w %.3f m', radii(k), results{k}.mass_kg, results{k}.workspace_radius_m);
  disp (line);
end
