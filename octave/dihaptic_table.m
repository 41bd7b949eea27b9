function [table, units, plain] = dihaptic_table(file)
% DIHAPTIC_TABLE reads a table of a session's, such as lifts.csv, or curves that
% "dihaptic export --csv" wrote.
%
%   [table, units] = dihaptic_table('lifts/lifts.csv');
%   plot(table.trial_num, table.peak_grip_N); ylabel(units.peak_grip_N);
%
% TABLE has a field for each column, dots in whose name are underscores: a column of
% numbers, NaN where a cell is empty, or a cell array of texts. UNITS has the unit of
% each column whose name ends in one, PLAIN the names of all columns without their units.
    here = fileparts(mfilename('fullpath'));
    facts = jsondecode(fileread(fullfile(here, 'facts.json')));
    [names, columns] = columns_of(file, facts.text_columns);
    table = struct();
    units = struct();
    plain = names;
    suffixes = fieldnames(facts.units);
    for c = 1:numel(names)
        field = strrep(strrep(names{c}, '.', '_'), '-', '_');
        table.(field) = columns{c};
        longest = '';
        for s = 1:numel(suffixes)
            suffix = regexprep(suffixes{s}, '^x(?=\d)', '');  % of a unit such as 1_m
            fits = numel(names{c}) > numel(suffix) + 1 && strcmp(names{c}(end - numel(suffix):end), ['_' suffix]);
            if fits && numel(suffix) > numel(longest)
                longest = suffix;
                units.(field) = facts.units.(suffixes{s});
                plain{c} = names{c}(1:end - numel(suffix) - 1);
            end
        end
    end
end

function [names, columns] = columns_of(file, texts)
    if exist(file, 'file') ~= 2
        error('dihaptic_table: %s is not there. Name a CSV file.', file);
    end
    text = strrep(fileread(file), sprintf('\r'), '');
    first = find([text sprintf('\n')] == sprintf('\n'), 1);
    names = strsplit(text(1:first - 1), ',');
    body = text(first + 1:end);
    numbers = isempty(regexp(body, '[^-+.0-9eE,\n]', 'once')) && ~any(ismember(names, texts));
    if numbers && ~isempty(body)
        all = dlmread(file, ',', 1, 0, 'emptyvalue', NaN);
        all(:, end + 1:numel(names)) = NaN;  % a last column that is empty
        columns = num2cell(all, 1);
    else
        columns = columns_of_cells(body, names, texts);
    end
end

function columns = columns_of_cells(body, names, texts)
    if ~isempty(body) && body(end) ~= sprintf('\n')
        body(end + 1) = sprintf('\n');
    end
    found = regexp(body, '("[^"]*(?:""[^"]*)*"|[^,\n"]*)[,\n]', 'tokens');
    cells = reshape(cellfun(@(token) token{1}, found, 'UniformOutput', false), numel(names), [])';
    columns = cell(1, numel(names));
    for c = 1:numel(names)
        column = strrep(regexprep(cells(:, c), '^"|"$', ''), '""', '"');
        numbers = str2double(column);
        if all(isfinite(numbers) | strcmp(column, '')) && ~any(strcmp(names{c}, texts))
            columns{c} = numbers;
        else
            columns{c} = column;
        end
    end
end
