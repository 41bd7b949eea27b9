% A test has no display.
function xlabel(varargin)
end
