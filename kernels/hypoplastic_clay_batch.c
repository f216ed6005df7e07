/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rates of the clay for several points at once; substeps and passes are those of the sand. */
#include "kernels/hypoplastic_clay_rates.h"
#include "kernels/hypoplastic_lanes.h"

PW_INLINE void stage_lanes(const pw_hypo *h, const pw_hypo_stage *stage, int n, bool with,
                           bool last)
{
  const pw_clay c = *(const pw_clay *)h; /* limits is its first member */
  const pw_hypo_stage a = *stage;
  const size_t ld = (size_t)n;
#pragma omp simd
  for (int i = 0; i < n; i++) {
    pw_t6 stress = pw_t6_load(a.stress + i, ld);
    pw_clay_factors k = pw_clay_factors_of(&c, stress, pw_log(1.0 + a.void_ratio[i]));
    pw_clay_rates s = pw_clay_rates_of(&c, &k, pw_t6_load(a.delta + i, ld),
                                       pw_t6_load(a.de + i, ld), a.size[i], with);
    pw_t6_store(s.stress, a.k + i, ld);
    pw_t6_store(s.delta, a.d + i, ld);
    a.able[i] *= pw_hypo_inside_shape(&c.limits, &k.g);
    if (last) {
      a.modulus[i] = pw_clay_modulus(&c, &k, with);
    }
  }
}

#define STAGE(pass, with, last, n)                                                                 \
  static void pass##_##with##_##last(const pw_hypo *h, const pw_hypo_stage *s)                     \
  {                                                                                                \
    stage_lanes(h, s, n, with, last);                                                              \
  }
STAGE(smooth, 0, 0, PW_HYPO_LANES)
STAGE(smooth, 0, 1, PW_HYPO_LANES)
STAGE(smooth, 1, 0, PW_HYPO_LANES)
STAGE(smooth, 1, 1, PW_HYPO_LANES)
STAGE(rest, 0, 0, PW_HYPO_REST_LANES)
STAGE(rest, 0, 1, PW_HYPO_REST_LANES)
STAGE(rest, 1, 0, PW_HYPO_REST_LANES)
STAGE(rest, 1, 1, PW_HYPO_REST_LANES)

void pw_clay_advance(const pw_clay *c, bool plane, const pw_stress_args *a, pw_real *done)
{
  static const pw_hypo_stage_fn smooth[2][2] = {{smooth_0_0, smooth_0_1}, {smooth_1_0, smooth_1_1}};
  static const pw_hypo_stage_fn rest[2][2] = {{rest_0_0, rest_0_1}, {rest_1_0, rest_1_1}};
  pw_hypo_smooth_with(&c->limits, smooth[c->intergranular], NULL, plane, a, done);
  pw_hypo_rest_with(&c->limits, rest[c->intergranular], plane, a, done);
}
