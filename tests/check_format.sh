#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Sources are formatted as .clang-format says (exit status 77: no clang-format 14 to ask).
set -eu
cd "$2"
tool=$(command -v clang-format-14 || command -v clang-format || true)
if [ -z "$tool" ] || ! "$tool" --version | grep -q 'version 14\.'; then
  echo "skipped: needs clang-format 14"
  exit 77
fi
list=$(find engine kernels partition io tests bench -name '*.[ch]')
bad=$(echo "$list" | xargs "$tool" --dry-run 2>&1 | sed -n 's/^\([^:]*\):.*clang-format-violations.*/\1/p' |
  sort -u)
if [ -n "$bad" ]; then
  echo "not formatted; $tool -i does it:"
  echo "$bad"
  exit 1
fi
echo "$(echo "$list" | wc -l) sources are formatted"
