% Octave 7 has none; MATLAB's has the fastest index first, as here
function out = h5readatt(file, name, key)
    out = single(load_array(sprintf('f["%s"].attrs["%s"]', name, key), file));
end
