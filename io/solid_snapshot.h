/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/solid_snapshot.h
 * @brief ParaView files of a solid scene (layer 4).
 *
 * Of each time: points_NNNN.vtp, one vertex per point with stress, volume ratios and the state of
 * its material, and mesh_NNNN.vtu, the elements where the mesh is, with the displacement of the last
 * step and the forces of the nodes that are held. The collection is that of io/snapshot.h.
 */
#ifndef PW_IO_SOLID_SNAPSHOT_H
#define PW_IO_SOLID_SNAPSHOT_H

#include "engine/implicit.h"
#include "io/snapshot.h"

/** @brief Write points and mesh now and add them to the collection. @return as
 *  pw_snapshots_write. */
pw_status pw_solid_snapshots_write(pw_snapshots *s, const pw_implicit *sim);

#endif /* PW_IO_SOLID_SNAPSHOT_H */
