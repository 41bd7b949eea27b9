#!/usr/bin/env bash
# The code is formatted as .clang-format says: ./dev format makes it so. Other versions of clang-format have other ideas, so
# that theirs is not asked.
set -euo pipefail
if ! clang-format --version 2>/dev/null | grep -q 'version 14\.'; then
    echo "SKIPPED: the code is formatted with clang-format 14, which Debian 12 has; this is $(clang-format --version 2>/dev/null || echo none)"
    exit 77
fi
if ! git rev-parse --is-inside-work-tree >/dev/null 2>&1; then
    echo "SKIPPED: git names the sources, and this folder is not a clone"
    exit 77
fi
git ls-files --cached --others --exclude-standard '*.h' '*.cpp' | xargs clang-format --dry-run --Werror
