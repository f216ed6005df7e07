/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/snapshot.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "engine/core/mem.h"
#include "engine/sim_state.h"
#include "io/atomic_file.h"
#include "io/point_values.h"
#include "io/vtk_files.h"

enum {
  MAX_COLUMNS = 16 + PW_MAX_STATE_COLUMNS,
  OUTLINE_POINTS = 16384, /* of one polyline */
  OUTLINES = 16,
  LINE = 128 /* bytes of a line of the collection at most */
};

typedef struct snapshot_entry {
  pw_real time_s;
  pw_snapshot_part part;
} snapshot_entry;

/* Files beside points_k.vtp. */
static const char *const part_file[] = {
    [PW_SNAPSHOT_OUTLINE] = "outline_%04d.vtp",
    [PW_SNAPSHOT_MESH] = "mesh_%04d.vtu",
};

struct pw_snapshots {
  char folder[PW_PATH];
  int n, room;
  snapshot_entry *entry; /* number k is points_k.vtp */
};

/* ---- collection ---- */

static pw_status add_entry(pw_snapshots *s, pw_real time_s, pw_snapshot_part part)
{
  if (s->n == s->room) {
    int room = s->room ? 2 * s->room : 64;
    snapshot_entry *larger = NULL;
    PW_TRY(pw_mem_alloc("list of snapshots", room, sizeof *larger, &larger));
    if (s->n > 0) {
      memcpy(larger, s->entry, (size_t)s->n * sizeof *larger);
    }
    pw_mem_free(&s->entry);
    s->entry = larger;
    s->room = room;
  }
  s->entry[s->n++] = (snapshot_entry){time_s, part};
  return PW_OK;
}

static pw_status write_collection(const pw_snapshots *s)
{
  char path[PW_PATH], file[LINE], *text = NULL;
  size_t size = (size_t)(2 * s->n + 5) * LINE, used = 0;
  PW_TRY(pw_path_join(s->folder, "run.pvd", path));
  PW_TRY(pw_mem_alloc("collection of snapshots", (pw_off)size, 1, &text));
#define ADD(...) used += (size_t)snprintf(text + used, size - used, __VA_ARGS__)
  ADD("<?xml version=\"1.0\"?>\n");
  ADD("<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n");
  ADD("  <Collection>\n");
  for (int k = 0; k < s->n; k++) {
    const pw_real t = s->entry[k].time_s;
    ADD("    <DataSet timestep=\"%.17g\" part=\"0\" file=\"points_%04d.vtp\"/>\n", t, k);
    if (s->entry[k].part != PW_SNAPSHOT_POINTS) {
      snprintf(file, sizeof file, part_file[s->entry[k].part], k);
      ADD("    <DataSet timestep=\"%.17g\" part=\"1\" file=\"%s\"/>\n", t, file);
    }
  }
  ADD("  </Collection>\n</VTKFile>\n");
#undef ADD
  pw_status status = pw_atomic_write(path, text, used);
  pw_mem_free(&text);
  return status;
}

/* Lines of our own making only: time, part and number of each file. */
static pw_status read_collection(pw_snapshots *s, pw_real last_s)
{
  char path[PW_PATH], line[4 * LINE];
  PW_TRY(pw_path_join(s->folder, "run.pvd", path));
  FILE *file = fopen(path, "r");
  if (!file && errno == ENOENT) {
    return PW_OK;
  }
  PW_REQUIRE(file, PW_ERR_FILE, "cannot read %s: %s", path, strerror(errno));
  pw_status status = PW_OK;
  while (status == PW_OK && fgets(line, sizeof line, file)) {
    double time_s;
    int part;
    if (sscanf(line, " <DataSet timestep=\"%lf\" part=\"%d\"", &time_s, &part) != 2 ||
        time_s > last_s) {
      continue;
    }
    if (part == 0) {
      status = add_entry(s, time_s, PW_SNAPSHOT_POINTS);
    } else if (s->n > 0) {
      const bool mesh = strstr(line, "file=\"mesh_") != NULL;
      s->entry[s->n - 1].part = mesh ? PW_SNAPSHOT_MESH : PW_SNAPSHOT_OUTLINE;
    }
  }
  fclose(file);
  return status;
}

static pw_status open_series(const char *folder, pw_real last_s, bool resume, pw_snapshots **out)
{
  *out = NULL;
  PW_REQUIRE(pw_vtk_available(), PW_ERR_UNSUPPORTED,
             "built without VTK, no ParaView files (Debian package: libvtk9-dev)");
  PW_REQUIRE(strlen(folder) < PW_PATH, PW_ERR_FILE, "%s: the path is too long", folder);
  PW_TRY(pw_make_folder(folder));
  PW_TRY(pw_mem_alloc("snapshots", 1, sizeof **out, out));
  snprintf((*out)->folder, sizeof(*out)->folder, "%s", folder);
  pw_status status = resume ? read_collection(*out, last_s) : PW_OK;
  if (status == PW_OK) {
    status = write_collection(*out);
  }
  if (status != PW_OK) {
    pw_snapshots_close(out);
  }
  return status;
}

pw_status pw_snapshots_open(const char *folder, pw_snapshots **out)
{
  return open_series(folder, 0.0, false, out);
}

pw_status pw_snapshots_resume(const char *folder, pw_real time_s, pw_snapshots **out)
{
  return open_series(folder, time_s, true, out);
}

void pw_snapshots_close(pw_snapshots **s)
{
  if (*s) {
    pw_mem_free(&(*s)->entry);
  }
  pw_mem_free(s);
}

pw_status pw_snapshots_path(const pw_snapshots *s, pw_snapshot_part part, char *path)
{
  char name[LINE];
  if (part == PW_SNAPSHOT_POINTS) {
    snprintf(name, sizeof name, "points_%04d.vtp", s->n);
  } else {
    snprintf(name, sizeof name, part_file[part], s->n);
  }
  return pw_path_join(s->folder, name, path);
}

pw_status pw_snapshots_add(pw_snapshots *s, pw_real time_s, pw_snapshot_part part)
{
  PW_TRY(add_entry(s, time_s, part));
  return write_collection(s);
}

/* ---- values of the points ---- */

typedef struct column column;

typedef struct source {
  const pw_scene *scene;
  const pw_points *p;
  int nstate;
  pw_state_column state[PW_MAX_STATE_COLUMNS];
} source;

struct column {
  const char *name;
  int ncomp;
  void (*value)(const source *s, int which, pw_idx i, float *out);
  int which; /* component or state */
};

static void plane_vector(const pw_points *p, const pw_real *field, pw_idx i, float *out)
{
  out[0] = (float)field[i];
  out[1] = (float)field[p->ld + i];
  out[2] = 0.0f;
}

static void value_position(const source *s, int which, pw_idx i, float *out)
{
  (void)which;
  plane_vector(s->p, s->p->x, i, out);
}

static void value_velocity(const source *s, int which, pw_idx i, float *out)
{
  (void)which;
  plane_vector(s->p, s->p->v, i, out);
}

static void value_stress(const source *s, int which, pw_idx i, float *out)
{
  *out = (float)s->p->stress[(pw_off)which * s->p->ld + i];
}

static void value_mass(const source *s, int which, pw_idx i, float *out)
{
  (void)which;
  *out = (float)s->p->mass[i];
}

static void value_volume(const source *s, int which, pw_idx i, float *out)
{
  (void)which;
  *out = (float)s->p->vol[i];
}

static void value_state(const source *s, int which, pw_idx i, float *out)
{
  *out = (float)pw_point_state(s->p, &s->state[which], i);
}

static void value_angle(const source *s, int which, pw_idx i, float *out)
{
  (void)which;
  *out = (float)pw_point_angle_deg(s->scene, s->p, i);
}

static bool any_angle(const pw_scene *scene)
{
  bool found = false;
  for (int b = 0; b < scene->nbody; b++) {
    found = found || pw_body_has_angle(scene, b);
  }
  return found;
}

static int list_columns(const source *s, column *list)
{
  static const column always[] = {
      {"position_m", 3, value_position, 0}, {"velocity_m_s", 3, value_velocity, 0},
      {"stress_xx_pa", 1, value_stress, 0}, {"stress_yy_pa", 1, value_stress, 1},
      {"stress_zz_pa", 1, value_stress, 2}, {"stress_xy_pa", 1, value_stress, 3},
      {"stress_yz_pa", 1, value_stress, 4}, {"stress_zx_pa", 1, value_stress, 5},
      {"mass_kg", 1, value_mass, 0},        {"volume_m3", 1, value_volume, 0},
  };
  int n = (int)(sizeof always / sizeof *always);
  memcpy(list, always, sizeof always);
  for (int k = 0; k < s->nstate; k++) {
    list[n++] = (column){s->state[k].name, 1, value_state, k};
  }
  if (any_angle(s->scene)) {
    list[n++] = (column){"mobilised_friction_angle_deg", 1, value_angle, 0};
  }
  return n;
}

/* Buffers of one snapshot. Cells are in the order of the points' ids, which does not change. */
typedef struct buffers {
  float *real, *xy;
  pw_idx *index, *start;
  int narray;
  pw_vtk_array array[MAX_COLUMNS];
} buffers;

static void free_buffers(buffers *b)
{
  pw_mem_free(&b->real);
  pw_mem_free(&b->xy);
  pw_mem_free(&b->index);
  pw_mem_free(&b->start);
}

static pw_status fill_columns(const source *s, buffers *b)
{
  const pw_points *p = s->p;
  column list[MAX_COLUMNS];
  int n = list_columns(s, list);
  pw_off width = 0;
  for (int k = 0; k < n; k++) {
    width += list[k].ncomp;
  }
  PW_TRY(pw_mem_alloc("values of a snapshot", width * p->n, sizeof *b->real, &b->real));
  PW_TRY(pw_mem_alloc("numbers of a snapshot", 2 * (pw_off)p->n, sizeof *b->index, &b->index));
  float *values = b->real;
  for (int k = 0; k < n; k++) {
    pw_vtk_array *array = &b->array[b->narray++];
    *array = (pw_vtk_array){.ncomp = list[k].ncomp, .real = values};
    snprintf(array->name, sizeof array->name, "%s", list[k].name);
    for (pw_idx id = 0; id < p->n; id++, values += list[k].ncomp) {
      list[k].value(s, list[k].which, p->slot[id], values);
    }
  }
  for (pw_idx id = 0; id < p->n; id++) {
    b->index[id] = id;
    b->index[p->n + id] = p->body[p->slot[id]];
  }
  b->array[b->narray++] = (pw_vtk_array){.name = "id", .ncomp = 1, .index = b->index};
  b->array[b->narray++] = (pw_vtk_array){.name = "body", .ncomp = 1, .index = b->index + p->n};
  return PW_OK;
}

static pw_status fill_shapes(const pw_points *p, buffers *b)
{
  const int vertices = pw_points_have_domains(p) ? 4 : 1;
  PW_TRY(pw_mem_alloc("cells of a snapshot", (pw_off)p->n + 1, sizeof *b->start, &b->start));
  PW_TRY(
      pw_mem_alloc("vertices of a snapshot", 2 * (pw_off)vertices * p->n, sizeof *b->xy, &b->xy));
  float *xy = b->xy;
  for (pw_idx id = 0; id < p->n; id++) {
    pw_idx i = p->slot[id];
    pw_real at[8] = {p->x[i], p->x[p->ld + i]};
    if (vertices == 4) {
      pw_point_corners(p, i, at);
    }
    for (int k = 0; k < 2 * vertices; k++) {
      *xy++ = (float)at[k];
    }
    b->start[id + 1] = vertices * (id + 1);
  }
  return PW_OK;
}

static pw_status write_points(const char *path, const pw_sim *sim)
{
  const pw_points *p = pw_sim_points(sim);
  source s = {.scene = pw_sim_scene(sim), .p = p};
  buffers b = {0};
  s.nstate = pw_state_columns(s.scene, s.state);
  pw_status status = fill_columns(&s, &b);
  if (status == PW_OK) {
    status = fill_shapes(p, &b);
  }
  if (status == PW_OK) {
    pw_vtk_cells cells = {
        .kind = pw_points_have_domains(p) ? PW_VTK_POLYGONS : PW_VTK_VERTICES,
        .ncell = p->n,
        .start = b.start,
        .xy = b.xy,
        .narray = b.narray,
        .array = b.array,
        .time_s = pw_sim_time(sim),
    };
    status = pw_vtk_write_cells(path, &cells);
  }
  free_buffers(&b);
  return status;
}

/* ---- outline ---- */

static pw_idx collect_outlines(const pw_sim *sim, pw_real *at, float *xy, pw_idx *start)
{
  pw_idx n = 0;
  for (; n < OUTLINES; n++) {
    int count = pw_sim_outline(sim, n, at, OUTLINE_POINTS);
    if (count <= 0) {
      break;
    }
    for (int k = 0; k < 2 * count; k++) {
      xy[2 * start[n] + k] = (float)at[k];
    }
    start[n + 1] = start[n] + count;
  }
  return n;
}

static pw_status write_outline(const char *path, const pw_sim *sim, bool *written)
{
  pw_real *at = NULL;
  float *xy = NULL;
  pw_idx start[OUTLINES + 1] = {0};
  *written = false;
  pw_status status = pw_mem_alloc("outline", 2 * OUTLINE_POINTS, sizeof *at, &at);
  if (status == PW_OK) {
    status = pw_mem_alloc("outlines", 2 * OUTLINE_POINTS * OUTLINES, sizeof *xy, &xy);
  }
  if (status == PW_OK) {
    pw_idx n = collect_outlines(sim, at, xy, start);
    pw_vtk_cells cells = {
        .kind = PW_VTK_LINES, .ncell = n, .start = start, .xy = xy, .time_s = pw_sim_time(sim)};
    status = n > 0 ? pw_vtk_write_cells(path, &cells) : PW_OK;
    *written = n > 0 && status == PW_OK;
  }
  pw_mem_free(&xy);
  pw_mem_free(&at);
  return status;
}

pw_status pw_snapshots_write(pw_snapshots *s, const pw_sim *sim)
{
  char path[PW_PATH];
  bool outline = false;
  PW_TRY(pw_snapshots_path(s, PW_SNAPSHOT_POINTS, path));
  PW_TRY(write_points(path, sim));
  PW_TRY(pw_snapshots_path(s, PW_SNAPSHOT_OUTLINE, path));
  PW_TRY(write_outline(path, sim, &outline));
  return pw_snapshots_add(s, pw_sim_time(sim), outline ? PW_SNAPSHOT_OUTLINE : PW_SNAPSHOT_POINTS);
}

/* ---- background grid ---- */

static void fill_nodes(const pw_nodes *nodes, int f, float *mass, float *velocity)
{
  const pw_real *rec = pw_nodes_field(nodes, f);
  for (pw_idx k = 0; k < nodes->nnode; k++, rec += PW_NODE) {
    mass[k] = (float)rec[PW_NODE_MASS];
    velocity[3 * k] = (float)rec[PW_NODE_VEL];
    velocity[3 * k + 1] = (float)rec[PW_NODE_VEL + 1];
  }
}

pw_status pw_snapshots_grid(pw_snapshots *s, const pw_sim *sim)
{
  char path[PW_PATH];
  const pw_nodes *nodes = &sim->nodes;
  const pw_mesh *mesh = pw_sim_mesh(sim);
  pw_vtk_array array[2 * PW_MAX_BODIES];
  float *values = NULL;
  PW_TRY(pw_path_join(s->folder, mesh->graded ? "grid.vtr" : "grid.vti", path));
  PW_TRY(pw_mem_alloc("values of the grid", 4 * (pw_off)nodes->nnode * nodes->nfield,
                      sizeof *values, &values));
  for (int f = 0; f < nodes->nfield; f++) {
    float *mass = values + 4 * (pw_off)nodes->nnode * f, *velocity = mass + nodes->nnode;
    fill_nodes(nodes, f, mass, velocity);
    array[2 * f] = (pw_vtk_array){.ncomp = 1, .real = mass};
    array[2 * f + 1] = (pw_vtk_array){.ncomp = 3, .real = velocity};
    const char *suffix = f == 0 ? "" : "_field_2";
    snprintf(array[2 * f].name, PW_VTK_NAME, "mass%s_kg", suffix);
    snprintf(array[2 * f + 1].name, PW_VTK_NAME, "velocity%s_m_s", suffix);
  }
  pw_vtk_grid grid = {
      .nodes = {mesh->nodes[0], mesh->nodes[1]},
      .origin = {mesh->origin[0], mesh->origin[1]},
      .cell = mesh->cell,
      .node = {mesh->axis[0].node, mesh->axis[1].node},
      .narray = 2 * nodes->nfield,
      .array = array,
      .time_s = pw_sim_time(sim),
  };
  pw_status status = pw_vtk_write_grid(path, &grid);
  pw_mem_free(&values);
  return status;
}
