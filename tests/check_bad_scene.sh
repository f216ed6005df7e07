#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Bad input: exit status 2, every error with its place, nothing written.
. "$(dirname "$0")/harness.sh"
good=$scenes/small_elastic.yaml

# expect_bad REGEX OPTIONS...: `run` and `check` refuse with a message.
expect_bad() {
  text=$1
  shift
  for command in run check; do
    expect_exit 2 "$program" $command "$@"
    expect_text stderr "$text"
  done
  expect_absent out
}

expect_bad 'missing.yaml' missing.yaml
expect_bad '.' .
: >empty.yaml
expect_bad 'empty.yaml' empty.yaml
printf 'a: [1, 2\nb: {' >broken.yaml
expect_bad 'broken.yaml:[0-9]+:[0-9]+' broken.yaml
head -c 4096 /dev/urandom >noise.yaml
expect_bad 'noise.yaml' noise.yaml

sed 's/model: linear_elastic/model: linear_elstic/' "$good" >material.yaml
expect_bad 'material.yaml:9:[0-9]+: .*linear_elastic' material.yaml
sed 's/material: block, shape/material: blok, shape/' "$good" >body.yaml
expect_bad 'body.yaml:11:[0-9]+: ' body.yaml
sed 's/cell_m: 0.1/cel_m: 0.1/' "$good" >key.yaml
expect_bad 'key.yaml:5:[0-9]+: .*cell_m' key.yaml
sed 's/^gravity/gravitation/' "$good" >effect.yaml
expect_bad 'effect.yaml:13:[0-9]+: .*gravity' effect.yaml
sed 's/poisson_ratio: 0.3/poisson_ratio: .nan/; s/cell_m: 0.1/cell_m: -1/' "$good" >two.yaml
expect_bad 'two.yaml:5:[0-9]+: ' two.yaml
expect_text stderr 'two.yaml:9:[0-9]+: '
sed 's/^gravity.*/&\n&/' "$good" >twice.yaml
expect_bad 'twice.yaml:14:[0-9]+: ' twice.yaml
sed '/^grid/d' "$good" >no_grid.yaml
expect_bad 'grid' no_grid.yaml
sed 's/size_m: \[1.2, 1.6\]/size_m: [0.5, 0.5]/' "$good" >outside.yaml
expect_bad 'block' outside.yaml

expect_bad 'gravity' "$good" --set gravity.acceleration=1
expect_bad 'end_s' "$good" --set time.end_s=soon
expect_bad 'novalue' "$good" --set novalue

# A folder that exists is left as it was.
mkdir kept
echo old >kept/history.csv
expect_exit 2 "$program" run key.yaml --out kept --force
expect_text kept/history.csv '^old$'
done_checking
