function out = readtable(file)
    lines = strsplit(strtrim(fileread(file)), "\n");
    names = strsplit(lines{1}, ',');
    for c = 1:numel(names)
        column = zeros(numel(lines) - 1, 1);
        for r = 2:numel(lines)
            cells = strsplit(lines{r}, ',', 'CollapseDelimiters', false);
            column(r - 1) = str2double(cells{c});
        end
        out.(names{c}) = column;
    end
end
