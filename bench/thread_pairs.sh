#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What a second thread brings: bench_step with one and two threads in turns, then both pile scenes
# with bench_threads, which takes turns by itself.
#   bench/thread_pairs.sh BUILD [pairs 9] [steps 300]
set -e
build=${1:?folder of the build} pairs=${2:-9} steps=${3:-300}
source_dir=$(cd "$(dirname "$0")/.." && pwd)
export OMP_PROC_BIND=${OMP_PROC_BIND:-false}
# As the program itself does: engine/main_bind.c.
export GOMP_SPINCOUNT=${GOMP_SPINCOUNT:-3000}

speed() { "$build/bench_step" "$1" "$steps" | sed -n 's/.*: \([0-9.]*\) M point-steps.*/\1/p'; }

echo "bench_step, $pairs pairs of $steps steps; M point-steps/s: lowest, median, highest"
for _ in $(seq "$pairs"); do
  one=$(speed 1)
  two=$(speed 2)
  echo "$one $two"
done | awk '
  function sort(v, n,   i, j, t) {
    for (i = 2; i <= n; i++)
      for (j = i; j > 1 && v[j - 1] > v[j]; j--) { t = v[j]; v[j] = v[j - 1]; v[j - 1] = t }
  }
  function show(name, v, n) {
    sort(v, n)
    printf "  %-28s %.2f %.2f %.2f\n", name, v[1], v[int((n + 1) / 2)], v[n]
  }
  { a[NR] = $1; b[NR] = $2; r[NR] = $2 / $1 }
  END { show("one thread", a, NR); show("two threads", b, NR); show("ratio of each pair", r, NR) }'

for scene in penalty frictional; do
  echo
  echo "hammered_pile/$scene.yaml"
  "$build/bench_threads" "$source_dir/cases/hammered_pile/$scene.yaml" 2 $((10 * pairs)) 5
done
