#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Comments of the headers name real parameters (clang's -Wdocumentation; lists of parameters
# separated by commas, which it does not know, are let through).
set -eu
cd "$2"
tool=$(command -v clang-14 || command -v clang || true)
[ -n "$tool" ] || { echo "skipped: needs clang"; exit 77; }
headers=$(find engine kernels partition io -name '*.h')
bad=$(for header in $headers; do
  "$tool" -std=c11 -D_POSIX_C_SOURCE=200809L -fsyntax-only -Wdocumentation -I. -x c "$header" 2>&1 |
    grep -E ' (warning|error): ' | grep -v "parameter '[a-z0-9_]*," || true
done | sed 's|^\./||' | sort -u)
if [ -n "$bad" ]; then
  echo "$bad"
  exit 1
fi
echo "$(echo "$headers" | wc -l) headers are documented as they are declared"
