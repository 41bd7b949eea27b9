% A test has no display.
function ylabel(varargin)
end
