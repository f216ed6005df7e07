/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Speed of the whole explicit step: axisymmetric CPDI, hypoplastic sand, a K0 column that moves
 * a little, about 10,000 points. Prints million point-steps a second and the time of each stage.
 *   bench_step [threads] [steps] [igs 0|1] [cells across] */
#include <stdio.h>
#include <stdlib.h>

#include "bench/sand.h"
#include "engine/sim_state.h"
#include "partition/share.h"

static void column(pw_scene *s, int igs, double cells)
{
  pw_scene_default(s);
  s->geometry = PW_AXI;
  double h = 5.0 / cells;
  s->grid.size_m[0] = 5.0;
  s->grid.size_m[1] = 10.0 + 2.0 * h;
  s->grid.cell_m = h;
  s->time.cfl = 0.5;
  bench_sand(&s->material[s->nmaterial++], igs != 0);
  s->body[s->nbody++] = (pw_scene_body){.name = "soil",
                                        .shape = PW_SHAPE_RECTANGLE,
                                        .x_m = {0.0, 5.0},
                                        .y_m = {0.0, 10.0},
                                        .velocity_m_s = {0.0, -0.05},
                                        .point_size_m = 0.5 * h};
  pw_initial_stress_param *k0 = pw_scene_add_effect(s, "initial_stress");
  k0->body = 0;
  k0->top_y_m = 10.0;
  k0->k0 = 0.5;
  k0->acceleration_m_s2 = 10.0;
  pw_gravity_param *g = pw_scene_add_effect(s, "gravity");
  g->acceleration_m_s2 = 10.0;
  pw_boundary_param *base = pw_scene_add_effect(s, "boundary");
  base->side = PW_SIDE_BOTTOM;
  base->fix_x = base->fix_y = true;
  base->body = -1;
  pw_boundary_param *side = pw_scene_add_effect(s, "boundary");
  side->side = PW_SIDE_RIGHT;
  side->fix_x = true;
  side->body = -1;
}

static void print_report(const pw_sim *sim, int threads, int steps)
{
  static const char *const stage[] = {"sort", "p2g", "nodes", "effects", "remap", "g2p_stress"};
  pw_report r;
  pw_sim_report(sim, &r);
  double updates = (double)r.points * steps;
  printf("threads %d points %d steps %d time %.4f s: %.3f M point-steps/s, %.0f ns each\n", threads,
         r.points, steps, r.time_s, updates / r.wall_s * 1e-6, 1e9 * r.wall_s / updates);
  printf("blocks %d colours %d bytes/point %lld sorts %lld substeps/update %.2f rhs/update %.2f\n",
         r.blocks, r.colours, (long long)r.bytes_per_point, (long long)r.sorts,
         (double)r.material.substeps / updates, (double)r.material.rhs / updates);
  pw_real coloured, plain;
  pw_share_bound(&sim->blocks, threads, &coloured, &plain);
  printf("bounds on the speed-up: coloured scatters %.3f, gather and stress %.3f\n", coloured,
         plain);
  for (int k = 0; k < PW_TIMER_COUNT; k++) {
    printf("  %-10s %6.1f ns/point\n", stage[k], 1e9 * r.stage_wall_s[k] / updates);
  }
}

int main(int argc, char **argv)
{
  int threads = argc > 1 ? atoi(argv[1]) : 1, steps = argc > 2 ? atoi(argv[2]) : 500;
  int igs = argc > 3 ? atoi(argv[3]) : 1;
  static pw_scene scene;
  pw_sim *sim = NULL;
  column(&scene, igs, argc > 4 ? atof(argv[4]) : 36.0);
  pw_status status = pw_sim_create(&scene, threads, &sim);
  for (int k = 0; k < steps && status == PW_OK; k++) {
    status = pw_sim_step(sim, 0.0);
  }
  if (status != PW_OK) {
    fprintf(stderr, "%s\n", pw_error_text());
    return 1;
  }
  print_report(sim, threads, steps);
  pw_sim_destroy(&sim);
  return 0;
}
