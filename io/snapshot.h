/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/snapshot.h
 * @brief ParaView files of a run (layer 4).
 *
 * In one folder: points_NNNN.vtp, one polygon per point (its domain; a vertex where the basis has
 * none) with the fields as cell data; outline_NNNN.vtp, the pile or interface as polylines;
 * grid.vti (grid.vtr of a graded grid), mass and velocity of the nodes at the end; run.pvd, the
 * collection with times, to be opened in ParaView. run.pvd is complete after each snapshot.
 */
#ifndef PW_IO_SNAPSHOT_H
#define PW_IO_SNAPSHOT_H

#include "engine/sim.h"

typedef struct pw_snapshots pw_snapshots;

/**
 * @brief Start a series in @p folder, which is made when missing.
 * @return PW_OK; PW_ERR_FILE; PW_ERR_MEMORY; PW_ERR_UNSUPPORTED when built without VTK, with the
 *         name of the missing package in the error text: @p out is then NULL, which the other
 *         functions do not accept, but pw_snapshots_close does.
 */
pw_status pw_snapshots_open(const char *folder, pw_snapshots **out);

/**
 * @brief Go on with the series of an earlier run: snapshots after @p time_s leave the collection.
 *        Write the snapshot of a time before its checkpoint.
 * @return as pw_snapshots_open.
 */
pw_status pw_snapshots_resume(const char *folder, pw_real time_s, pw_snapshots **out);

/**
 * @brief Write the points and the outline now and add them to the collection.
 * @return PW_OK; PW_ERR_FILE with path and reason; PW_ERR_MEMORY.
 */
pw_status pw_snapshots_write(pw_snapshots *s, const pw_sim *sim);

/** @brief Write grid.vti, of a graded grid grid.vtr: the nodes as the last step left them.
 *  @return as pw_snapshots_write. */
pw_status pw_snapshots_grid(pw_snapshots *s, const pw_sim *sim);

/** Files of one time: the points, and what else there is. */
typedef enum pw_snapshot_part {
  PW_SNAPSHOT_POINTS,  /**< alone */
  PW_SNAPSHOT_OUTLINE, /**< outline_NNNN.vtp */
  PW_SNAPSHOT_MESH,    /**< mesh_NNNN.vtu of a solid scene (io/solid_snapshot.h) */
} pw_snapshot_part;

/** @brief Name of the file that a part has next. @param[out] path [PW_PATH]
 *  @return PW_OK; PW_ERR_FILE when it is too long. */
pw_status pw_snapshots_path(const pw_snapshots *s, pw_snapshot_part part, char *path);

/** @brief Take the files written under those names into the collection. @return as
 *  pw_snapshots_write. */
pw_status pw_snapshots_add(pw_snapshots *s, pw_real time_s, pw_snapshot_part part);

/** @brief Free and null; NULL is accepted. */
void pw_snapshots_close(pw_snapshots **s);

#endif /* PW_IO_SNAPSHOT_H */
