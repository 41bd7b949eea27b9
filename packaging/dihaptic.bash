# Completion for bash: commands, their options, and files. All are asked of the program, so that nothing is listed twice.
_dihaptic() {
    local cur prev words cword
    _init_completion || return
    if ((cword == 1)); then
        mapfile -t COMPREPLY < <(compgen -W "$(dihaptic --help |
            awk '/^Subcommands:/ { on = 1; next } !NF { on = 0 } on { print $1 }') --help --version" -- "$cur")
    elif [[ $cur == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(dihaptic "${words[1]}" --help | grep -oE '(^|[ ,])--?[a-z][a-z-]*' |
            tr -d ' ,')" -- "$cur")
    else
        _filedir
    fi
}
complete -F _dihaptic dihaptic
