function reader(folder, name)
  index = jsondecode(fileread([folder '/index.json']));
  entry = index.problems(strcmp({index.problems.name}, name));
  shape = entry.problem.shape(:)';
  file = fopen([folder '/' entry.files.pressure], 'r', 'ieee-le');
  pressure = fread(file, fliplr(shape), 'double')';  % row i along x, column j along y
  fclose(file);
  area = prod(entry.problem.lengths) / prod(shape);
  [peak, k] = max(reshape(pressure', [], 1));
  at = [floor((k - 1) / shape(2)), mod(k - 1, shape(2))];
  fprintf('%s: %d x %d, load %.9g N, ', name, shape, sum(pressure(:)) * area);
  fprintf('peak %.9g Pa at %d, %d\n', peak, at);
end
