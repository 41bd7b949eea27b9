function session = dihaptic_load(folder, varargin)
% DIHAPTIC_LOAD reads a session: its tables, and the curves that are named.
%
%   s = dihaptic_load('lifts', 'grip_force', 'block.position');
%   plot(s.t, s.grip_force); xlabel('time [s]'); ylabel(['grip force [' s.units.grip_force ']']);
%   s.tables.trials.outcome{1}
%   s.table_units.lifts.peak_grip_N
%
% Curves have the names of docs/quantities.md, in SI units, and a field each, dots in
% whose name are underscores: a number a tick, or a row of components, which are x y z, or
% w x y z of an orientation. SESSION also has the time of each tick, t [s], and the
% number of its trial, 0 between trials. Curves are read by the program dihaptic, since
% Octave cannot read session.nwb; on a computer without it, read a file that
% "dihaptic export --csv" wrote by dihaptic_table. Tables need no program.
    files = dir(fullfile(folder, '*.csv'));
    if exist(fullfile(folder, 'session.yaml'), 'file') ~= 2
        error('dihaptic_load: %s is not a session: it has no session.yaml. Name a folder made by dihaptic.', folder);
    end
    session = struct('folder', folder, 'units', struct(), 'tables', struct(), 'table_units', struct());
    for f = 1:numel(files)
        [~, stem] = fileparts(files(f).name);
        name = strrep(stem, '-', '_');
        [session.tables.(name), session.table_units.(name)] = dihaptic_table(fullfile(folder, files(f).name));
    end
    if ~isempty(varargin)
        session = add_curves(session, folder, varargin);
    end
end

function session = add_curves(session, folder, names)
    file = [tempname() '.csv'];
    removed = onCleanup(@() remove(file));
    command = sprintf('dihaptic export "%s" --csv "%s" --out "%s" 2>&1', folder, strjoin(names, ','), file);
    [status, said] = system(command);
    if status ~= 0
        error('dihaptic_load: %s', strtrim(said));
    end
    [table, units, plain] = dihaptic_table(file);
    session.t = table.t_s;
    session.trial = table.trial;
    fields = fieldnames(table);
    for n = 1:numel(names)
        parts = [names(n), strcat(names{n}, {'.w', '.x', '.y', '.z'})];
        own = fields(ismember(plain, parts))';
        field = strrep(names{n}, '.', '_');
        session.(field) = cell2mat(cellfun(@(part) table.(part), own, 'UniformOutput', false));
        session.units.(field) = '1';
        if isfield(units, own{1})
            session.units.(field) = units.(own{1});
        end
    end
end

function remove(file)
    if exist(file, 'file') == 2
        delete(file);
    end
end
