% The evaluation in Octave, as a user of Octave would write it: 6x6 virtual-joint stiffness by matrix algebra, one pose
% at a time, ray by ray of the reference grid.
%
%   octave-cli benches/baselines/plain.m            % time per pose, and R_w of one design (minutes)

1;

function [good, sgn] = pose(d, x, y, phi)
  E = 210e9; G = 80e9; K_act = 1e7;
  good = false; sgn = 0;
  angles = [210, 330, 90] * pi / 180;
  p = [x; y];
  A = d.R * [cos(angles); sin(angles)];
  arm = d.r * [cos(phi + angles); sin(phi + angles)];
  C = p + arm;
  J = zeros(3, 3); drive = zeros(3, 1); B = zeros(2, 3); U = zeros(2, 3); len = d.L * ones(1, 3);
  for i = 1:3
    v = C(:, i) - A(:, i);
    switch d.kind
      case '3-PRR'
        e = A(:, mod(i, 3) + 1) - A(:, i); e = e / norm(e);
        h = e(1) * v(2) - e(2) * v(1);
        if abs(h) > d.L, return; end
        rho = v' * e + sqrt(d.L^2 - h^2);
        if rho < 0 || rho > sqrt(3) * d.R, return; end
        B(:, i) = A(:, i) + rho * e;
        u = (C(:, i) - B(:, i)) / d.L; drive(i) = u' * e;
      case '3-RPR'
        len(i) = norm(v);
        if len(i) < d.L / 2 || len(i) > d.L, return; end
        B(:, i) = A(:, i); u = v / len(i); drive(i) = 1;
      case '3-RRR'
        s = norm(v);
        if s > 2 * d.L || s == 0, return; end
        B(:, i) = (A(:, i) + C(:, i)) / 2 + sqrt(d.L^2 - s^2 / 4) * [-v(2); v(1)] / s;
        u = (C(:, i) - B(:, i)) / d.L;
        w = B(:, i) - A(:, i); drive(i) = w(1) * u(2) - w(2) * u(1);
    end
    U(:, i) = u;
    J(i, :) = [u', arm(1, i) * u(2) - arm(2, i) * u(1)];
  end
  M = diag(1 ./ drive) * J * diag([1, 1, 1 / d.r]);
  if 3 / sqrt(trace(M' * M) * trace(inv(M' * M))) < 0.1, return; end
  K = zeros(6);
  for i = 1:3
    switch d.kind
      case '3-PRR'
        e = A(:, mod(i, 3) + 1) - A(:, i); t = [e / norm(e); 0; 0; 0; 0];
      case '3-RPR'
        t = [U(:, i); 0; 0; 0; 0];
      case '3-RRR'
        t = revolute(A(:, i), p);
    end
    S = t * t' / K_act;
    if strcmp(d.kind, '3-RRR')
      S = S + spring(bar(d.rj, d.L, E, G), (B(:, i) - A(:, i)) / d.L, B(:, i), p);
    end
    S = S + spring(bar(d.rj, len(i), E, G), U(:, i), C(:, i), p);
    S = S + spring(bar(d.rp, d.r, E, G), -arm(:, i) / d.r, p, p);
    Jq = [revolute(B(:, i), p), revolute(C(:, i), p)];
    X = inv([S, Jq; Jq', zeros(2)]);
    K = K + X(1:6, 1:6);
  end
  good = min(eig(K(1:2, 1:2))) >= 1e6 && K(3, 3) >= 1e5 && K(6, 6) >= 10 / (pi / 180);
  sgn = sign(det(J));
end

function C = bar(radius, L, E, G)
  a = pi * radius^2; I = pi * radius^4 / 4;
  C = diag([L / (E * a), L^3 / (3 * E * I), L^3 / (3 * E * I), L / (G * 2 * I), L / (E * I), L / (E * I)]);
  C(2, 6) = L^2 / (2 * E * I); C(6, 2) = C(2, 6);
  C(3, 5) = -L^2 / (2 * E * I); C(5, 3) = C(3, 5);
end

function S = spring(C, axis, tip, p)
  rotation = [axis(1), -axis(2), 0; axis(2), axis(1), 0; 0, 0, 1];
  v = p - tip;
  lever = [0, 0, -v(2); 0, 0, v(1); v(2), -v(1), 0];
  J = [rotation, lever * rotation; zeros(3), rotation];
  S = J * C * J';
end

function t = revolute(joint, p)
  v = p - joint;
  t = [-v(2); v(1); 0; 0; 0; 1];
end

function [best, poses] = workspace_radius(d)
  step = d.R / 50; radius = zeros(1, 144); signs = zeros(1, 144); poses = 0;
  for k = 1:144
    phi = (k - 1) * 2.5 * pi / 180;
    [good, signs(k)] = pose(d, 0, 0, phi); poses = poses + 1;
    if ~good, signs(k) = 0; continue; end
    radius(k) = inf;
    for m = 0:35
      c = cos(m * 10 * pi / 180); s = sin(m * 10 * pi / 180); n = 0; passes = true;
      while passes
        n = n + 1;
        [good, sgn] = pose(d, n * step * c, n * step * s, phi); poses = poses + 1;
        passes = good && sgn == signs(k);
      end
      low = (n - 1) * step; high = n * step;
      for h = 1:12
        middle = (low + high) / 2;
        [good, sgn] = pose(d, middle * c, middle * s, phi); poses = poses + 1;
        if good && sgn == signs(k), low = middle; else, high = middle; end
      end
      radius(k) = min(radius(k), low);
    end
  end
  best = 0;
  for home = 1:144
    window = mod((home - 5:home + 3), 144) + 1;
    if signs(home) ~= 0 && all(signs(window) == signs(home)), best = max(best, min(radius(window))); end
  end
end

designs = {struct('kind', '3-PRR', 'R', 3.066, 'r', 1.283, 'L', 1.896, 'rj', 0.036, 'rp', 0.056), ...
           struct('kind', '3-RPR', 'R', 2.0, 'r', 0.8, 'L', 2.4, 'rj', 0.05, 'rp', 0.05), ...
           struct('kind', '3-RRR', 'R', 2.0, 'r', 0.8, 'L', 1.6, 'rj', 0.05, 'rp', 0.05)};
for k = 1:3
  n = 500; t = tic; count = 0;
  for m = 0:n - 1
    radius = 0.2 * sqrt((m + 0.5) / n); angle = 2.399963 * m;
    count = count + pose(designs{k}, radius * cos(angle), radius * sin(angle), 30 * pi / 180);
  end
  printf('%s: %.0f us per pose (%d of %d feasible)\n', designs{k}.kind, toc(t) / n * 1e6, count, n);
end
t = tic;
[radius, poses] = workspace_radius(designs{1});
printf('%s: R_w %.6f m, %d poses, %.1f s\n', designs{1}.kind, radius, poses, toc(t));
