/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kernels/transfer.h"

#include <string.h>

#include "kernels/transfer_common.h"

/* CPDI: four vertices per point, the corners of its domain. */
#define PW_TAG plane_cpdi_quad4
#define PW_AXI 0
#include "kernels/transfer_cpdi.inc"
#define PW_TAG axi_cpdi_quad4
#define PW_AXI 1
#include "kernels/transfer_cpdi.inc"

/* Tensor-product bases sampled at the point: uGIMP (3 x 3 nodes) and linear (2 x 2 nodes). */
#define PW_TAG  plane_ugimp_quad4
#define PW_AXI  0
#define PW_SPAN 3
#include "kernels/transfer_tensor.inc"
#define PW_TAG  axi_ugimp_quad4
#define PW_AXI  1
#define PW_SPAN 3
#include "kernels/transfer_tensor.inc"
#define PW_TAG  plane_linear_quad4
#define PW_AXI  0
#define PW_SPAN 2
#include "kernels/transfer_tensor.inc"
#define PW_TAG  axi_linear_quad4
#define PW_AXI  1
#define PW_SPAN 2
#include "kernels/transfer_tensor.inc"

static const pw_kernels instances[] = {
#define PW_INSTANCE(tag, geometry, basis, vertices)                                                \
  {#tag,                                                                                           \
   geometry,                                                                                       \
   basis,                                                                                          \
   vertices,                                                                                       \
   weights_##tag,                                                                                  \
   p2g_##tag,                                                                                      \
   p2g_momentum_##tag,                                                                             \
   p2g_force_##tag,                                                                                \
   g2p_velocity_##tag,                                                                             \
   g2p_settle_##tag,                                                                               \
   p2g_remap_##tag,                                                                                \
   g2p_gradient_##tag,                                                                             \
   p2g_surface_##tag},
#include "kernels/instances.def"
#undef PW_INSTANCE
};

const pw_kernels *pw_kernels_at(int i)
{
  int count = (int)(sizeof instances / sizeof instances[0]);
  return i >= 0 && i < count ? &instances[i] : NULL;
}

const pw_kernels *pw_kernels_find(int geometry, int basis)
{
  for (int i = 0; pw_kernels_at(i); i++) {
    if (instances[i].geometry == geometry && instances[i].basis == basis) {
      return &instances[i];
    }
  }
  return NULL;
}
