/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/main.h"

#include <omp.h>
#include <stdlib.h>
#include <unistd.h>

/* Where the runtime looks up which processors are one core; absent in some containers. */
static const char topology[] = "/sys/devices/system/cpu/cpu0/topology/core_id";

/* How often a thread of gcc's runtime looks whether a barrier has opened before it sleeps: some
 * 0.05 ms, longer than the threads of a step wait for each other while each has its processor. The
 * default is a hundred times that: beside other programs, those that wait then take the processor
 * from the one they wait for, and two threads were up to five times slower than one. */
static const char patience[] = "3000";

/* True when anything was set that the runtime reads only as it starts. */
static bool set_up_runtime(int threads)
{
  bool set = false;
  if (!getenv("OMP_WAIT_POLICY") && !getenv("GOMP_SPINCOUNT") && threads > 1) {
    set = setenv("GOMP_SPINCOUNT", patience, 1) == 0;
  }
  if (!getenv("OMP_PROC_BIND") && !getenv("OMP_PLACES") && threads > 1 &&
      2 * threads > omp_get_num_procs() && access(topology, R_OK) == 0) {
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
