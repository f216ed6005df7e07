/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kernels/transfer.h"

#include <math.h>
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
#define PW_TAG    plane_ugimp_quad4
#define PW_AXI    0
#define PW_SPAN   3
#define PW_GRADED 0
#include "kernels/transfer_tensor.inc"
#define PW_TAG    axi_ugimp_quad4
#define PW_AXI    1
#define PW_SPAN   3
#define PW_GRADED 0
#include "kernels/transfer_tensor.inc"
#define PW_TAG    plane_linear_quad4
#define PW_AXI    0
#define PW_SPAN   2
#define PW_GRADED 0
#include "kernels/transfer_tensor.inc"
#define PW_TAG    axi_linear_quad4
#define PW_AXI    1
#define PW_SPAN   2
#define PW_GRADED 0
#include "kernels/transfer_tensor.inc"

#define PW_TAG    plane_linear_graded
#define PW_AXI    0
#define PW_SPAN   2
#define PW_GRADED 1
#include "kernels/transfer_tensor.inc"
#define PW_TAG    axi_linear_graded
#define PW_AXI    1
#define PW_SPAN   2
#define PW_GRADED 1
#include "kernels/transfer_tensor.inc"

#define PW_ROW(name, tag, weights, geometry, basis, vertices)                                      \
  {                                                                                                \
    name, geometry, basis, vertices, weights, p2g_##tag, p2g_momentum_##tag, p2g_force_##tag,      \
        g2p_velocity_##tag, g2p_settle_##tag, p2g_remap_##tag, g2p_gradient_##tag,                 \
        p2g_surface_##tag, p2g_extent_##tag, support_of_##tag                                      \
  }

static const pw_kernels instances[] = {
#define PW_INSTANCE(tag, geometry, basis, vertices)                                                \
  PW_ROW(#tag, tag, weights_##tag, geometry, basis, vertices),
#include "kernels/instances.def"
#undef PW_INSTANCE
};

/* CPDI knows the grid only by the places of its corners: the other kernels are the same. */
static const pw_kernels graded[] = {
    PW_ROW("plane_cpdi_graded", plane_cpdi_quad4, weights_graded_plane_cpdi_quad4, 0, 2, 4),
    PW_ROW("axi_cpdi_graded", axi_cpdi_quad4, weights_graded_axi_cpdi_quad4, 1, 2, 4),
    PW_ROW("plane_linear_graded", plane_linear_graded, weights_plane_linear_graded, 0, 0, 1),
    PW_ROW("axi_linear_graded", axi_linear_graded, weights_axi_linear_graded, 1, 0, 1)};

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

const pw_kernels *pw_kernels_find_graded(int geometry, int basis)
{
  for (size_t i = 0; i < sizeof graded / sizeof graded[0]; i++) {
    if (graded[i].geometry == geometry && graded[i].basis == basis) {
      return &graded[i];
    }
  }
  return NULL;
}
