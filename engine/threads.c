/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/threads.h"

#include <omp.h>

int pw_threads_default(void)
{
  return omp_get_max_threads();
}

void pw_threads_set_default(int threads)
{
  omp_set_num_threads(threads);
}
