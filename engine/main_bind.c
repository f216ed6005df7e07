/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/main.h"

#include <omp.h>
#include <stdlib.h>
#include <unistd.h>

/* Where the runtime looks up which processors are one core; absent in some containers. */
static const char topology[] = "/sys/devices/system/cpu/cpu0/topology/core_id";

/* How often a thread of gcc's runtime looks whether a barrier has opened before it sleeps. A thread
 * that is held to its processor looks for some 0.5 ms, longer than the serial parts of a step: on
 * two idle processors two threads were then 2.00 times as fast as one (median of bench_step; 1.83
 * with a tenth of that patience, 1.95 and 1.98 with three and ten times). A thread that may be
 * moved looks for a tenth of that. The default of the runtime is ten times the larger: beside other
 * programs those that wait then take the processor from the one they wait for. Two threads beside
 * six other programs on two processors, in turns: held 0.2 times as fast as one with the default,
 * 0.7 to 1.0 with the larger, 0.8 to 1.15 with the smaller; not held 0.17 and 0.5 with these. */
static const char patience_held[] = "30000", patience_moved[] = "3000";

/* Threads that need more than half of the processors keep to one each. Fewer stay free: two runs
 * side by side would be held to the same, since places begin with the first processor. */
static bool should_hold(int threads)
{
  return !getenv("OMP_PROC_BIND") && !getenv("OMP_PLACES") && 2 * threads > omp_get_num_procs() &&
         access(topology, R_OK) == 0;
}

/* True when anything was set that the runtime reads only as it starts. */
static bool set_up_runtime(int threads)
{
  bool set = false;
  if (threads < 2) {
    return false;
  }
  const bool hold = should_hold(threads), held = omp_get_proc_bind() != omp_proc_bind_false;
  if (!getenv("OMP_WAIT_POLICY") && !getenv("GOMP_SPINCOUNT")) {
    set = setenv("GOMP_SPINCOUNT", hold || held ? patience_held : patience_moved, 1) == 0;
  }
  if (hold) {
    set = setenv("OMP_PROC_BIND", "true", 1) == 0 && setenv("OMP_PLACES", "cores", 1) == 0;
  }
  return set;
}

bool pw_main_bind_threads(char **argv, int threads)
{
  if (threads < 1) {
    threads = omp_get_max_threads();
  }
  if (set_up_runtime(threads)) {
    execv("/proc/self/exe", argv); /* returns only when it cannot be done: go on as it is */
  }
  return threads > 1 && omp_get_proc_bind() != omp_proc_bind_false;
}
