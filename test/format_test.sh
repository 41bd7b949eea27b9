#!/usr/bin/env bash
# The code is formatted as .clang-format says: ./dev format makes it so.
set -euo pipefail
git ls-files --cached --others --exclude-standard '*.h' '*.cpp' | xargs clang-format --dry-run --Werror
