/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/main.h"

#include <omp.h>
#include <stdlib.h>
#include <unistd.h>

/* Where the runtime looks up which processors are one core; absent in some containers. */
static const char topology[] = "/sys/devices/system/cpu/cpu0/topology/core_id";

bool pw_main_bind_threads(char **argv, int threads)
{
  if (threads < 1) {
    threads = omp_get_max_threads();
  }
  if (!getenv("OMP_PROC_BIND") && !getenv("OMP_PLACES") && threads > 1 &&
      2 * threads > omp_get_num_procs() && access(topology, R_OK) == 0) {
    setenv("OMP_PROC_BIND", "true", 1);
    setenv("OMP_PLACES", "cores", 1);
    execv("/proc/self/exe", argv); /* returns only when it cannot be done: go on unbound */
  }
  return threads > 1 && omp_get_proc_bind() != omp_proc_bind_false;
}
