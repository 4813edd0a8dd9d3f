function results = kinefront (designs, varargin)
% KINEFRONT  Evaluate designs of planar parallel manipulators by the program kinefront.
%
%   RESULTS = KINEFRONT (DESIGNS) evaluates a cell array of design texts, such as
%   '3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056', and returns a cell array of structures with the fields of
%   `kinefront evaluate --json`. A text that is no design gives a structure with the field `error`.
%
%   RESULTS = KINEFRONT (DESIGNS, ARGUMENTS...) passes arguments on, such as '--study', 'mine.toml' or '--grid', 'fine'.
%
%   The program is found on the PATH, or by the environment variable KINEFRONT. It works in MATLAB and in Octave 7 or later.
  program = getenv ('KINEFRONT');
  if isempty (program)
    program = 'kinefront';
  end
  input = [tempname() '.txt'];
  file = fopen (input, 'w');
  if file < 0
    error ('kinefront:file', 'cannot write %s', input);
  end
  fprintf (file, '%s\n', designs{:});
  fclose (file);
  quoted = sprintf (' "%s"', varargin{:});
  if isempty (varargin)
    quoted = '';
  end
  command = sprintf ('"%s" evaluate --stdin%s < "%s"', program, quoted, input);
  [status, output] = system (command);
  delete (input);
  if status ~= 0
    error ('kinefront:program', '%s failed:\n%s', command, output);
  end
  lines = strsplit (strtrim (output), sprintf ('\n'));
  results = cellfun (@jsondecode, lines, 'UniformOutput', false);
end
