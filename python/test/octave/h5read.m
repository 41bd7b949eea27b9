% Octave 7 has none; MATLAB's has the fastest index first, as here
function out = h5read(file, name)
    out = load_array(sprintf('f["%s"][...]', name), file);
end
