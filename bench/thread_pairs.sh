#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What a second thread brings, beside what a second processor brings: in each round bench_step with
# one thread, twice with one thread at the same time (the sum of their speeds is the most that two
# threads can reach on the machine of that moment) and with two threads; then both pile scenes with
# bench_threads, which takes such turns by itself.
#   bench/thread_pairs.sh BUILD [rounds 9] [steps 300]
set -e
build=${1:?folder of the build} rounds=${2:-9} steps=${3:-300}
source_dir=$(cd "$(dirname "$0")/.." && pwd)
# As the program itself does where threads take more than half of the processors:
# engine/main_bind.c.
export OMP_PLACES=${OMP_PLACES:-cores} GOMP_SPINCOUNT=${GOMP_SPINCOUNT:-30000}
bind=${OMP_PROC_BIND:-true}
beside=$(mktemp)
trap 'rm -f "$beside"' EXIT

# One thread is never held: two runs would be held to the same processor.
speed() {
  OMP_PROC_BIND=$([ "$1" = 1 ] && echo false || echo "$bind") "$build/bench_step" "$1" "$steps" |
    sed -n 's/.*: \([0-9.]*\) M point-steps.*/\1/p'
}

echo "bench_step, $rounds rounds of $steps steps; lowest, median, highest"
for _ in $(seq "$rounds"); do
  one=$(speed 1)
  speed 1 >"$beside" &
  both=$(speed 1)
  wait $!
  two=$(speed 2)
  echo "$one $both $(cat "$beside") $two"
done | awk '
  function sort(v, n,   i, j, t) {
    for (i = 2; i <= n; i++)
      for (j = i; j > 1 && v[j - 1] > v[j]; j--) { t = v[j]; v[j] = v[j - 1]; v[j - 1] = t }
  }
  function show(name, v, n) {
    sort(v, n)
    printf "  %-44s %.2f %.2f %.2f\n", name, v[1], v[int((n + 1) / 2)], v[n]
  }
  { a[NR] = $1; s[NR] = $2 + $3; b[NR] = $4
    r[NR] = $4 / $1; c[NR] = ($2 + $3) / $1; p[NR] = $4 / ($2 + $3) }
  END {
    show("one thread, M point-steps/s", a, NR)
    show("two runs with one thread, together", s, NR)
    show("two threads", b, NR)
    show("two threads to one", r, NR)
    show("two runs to one", c, NR)
    show("two threads to two runs", p, NR)
  }'

for scene in penalty frictional; do
  echo
  echo "hammered_pile/$scene.yaml"
  OMP_PROC_BIND=$bind "$build/bench_threads" "$source_dir/cases/hammered_pile/$scene.yaml" 2 \
    $((10 * rounds)) 5
done
