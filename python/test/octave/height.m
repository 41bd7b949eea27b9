function out = height(t)
    out = numel(t.trial_num);
end
