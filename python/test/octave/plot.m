% A test has no display.
function plot(varargin)
end
