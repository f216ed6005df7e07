/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Interface lines from the outlines of a scene's bodies. */
#include "engine/interface.h"

#include <math.h>

#include "engine/bodies.h"
#include "engine/core/mem.h"

enum { GROWTH = 8 }; /* room for splits, times the nodes at the start */

static const pw_real ON_EDGE = 1e-9; /* m */

/* Bounding box of a body: x from, x to, y from, y to. */
static void bounds(const pw_scene_body *b, pw_real *box)
{
  if (b->shape == PW_SHAPE_RECTANGLE) {
    box[0] = b->x_m[0];
    box[1] = b->x_m[1];
    box[2] = b->y_m[0];
    box[3] = b->y_m[1];
  } else if (b->shape == PW_SHAPE_RING) {
    pw_body_ring_box(b, box);
  } else {
    bool pile = b->shape == PW_SHAPE_PILE;
    box[0] = b->centre_m[0] - b->radius_m;
    box[1] = b->centre_m[0] + b->radius_m;
    box[2] = pile ? b->tip_y_m : b->centre_m[1] - b->radius_m;
    box[3] = pile ? b->tip_y_m + b->length_m : b->centre_m[1] + b->radius_m;
  }
}

/* Side of box `own` across which `other` lies: 0 left, 1 right, 2 bottom, 3 top. */
static int facing_side(const pw_real *own, const pw_real *other)
{
  const pw_real clear[4] = {own[0] - other[1], other[0] - own[1], own[2] - other[3],
                            other[2] - own[3]};
  int best = 3;
  for (int s = 2; s >= 0; s--) {
    best = clear[s] > clear[best] ? s : best;
  }
  return best;
}

/* What to keep of a closed outline. */
typedef struct part {
  int axis;     /* coordinate that is given */
  pw_real at;   /* its value; m */
  bool inverse; /* keep what is NOT there */
} part;

static bool on_part(const part *p, const pw_real *xy)
{
  return fabs(xy[p->axis] - p->at) < ON_EDGE;
}

/* Keep segments with (or without) both ends on the part, as one open run; to: new vertices.
 * @return vertices kept. */
static int keep_run(const part *p, const pw_real *xy, const bool *tip, int n, pw_real *to,
                    bool *to_tip)
{
  int start = -1, count = 0;
  for (int k = 0; k < n && start < 0; k++) {
    bool here = on_part(p, xy + 2 * k) && on_part(p, xy + 2 * ((k + 1) % n));
    bool last = on_part(p, xy + 2 * k) && on_part(p, xy + 2 * ((k + n - 1) % n));
    start = (here != p->inverse) && (last == p->inverse) ? k : -1;
  }
  for (int i = 0; i < n && start >= 0; i++) {
    int k = (start + i) % n, next = (k + 1) % n;
    bool both = on_part(p, xy + 2 * k) && on_part(p, xy + 2 * next);
    to[2 * count] = xy[2 * k];
    to[2 * count + 1] = xy[2 * k + 1];
    to_tip[count++] = tip[k];
    if (both == p->inverse) {
      break;
    }
  }
  return count;
}

/* What of the outline takes part; false: all of it. */
static bool choose_part(const pw_scene *scene, int body, int facing, part *out)
{
  const pw_scene_body *b = &scene->body[body];
  if (scene->geometry != PW_AXI || b->shape == PW_SHAPE_PILE) {
    return false;
  }
  pw_real own[4], other[4];
  bounds(b, own);
  if (b->shape == PW_SHAPE_RECTANGLE && facing >= 0) {
    bounds(&scene->body[facing], other);
    int side = facing_side(own, other);
    *out = (part){.axis = side / 2, .at = own[side]};
    return true;
  }
  *out = (part){.axis = 0, .at = 0.0, .inverse = true};
  return fabs(own[0]) < ON_EDGE;
}

/* Scratch for the outline of a body. */
typedef struct outline {
  pw_real *xy, *kept;
  bool *tip, *kept_tip;
} outline;

static void outline_destroy(outline *o)
{
  pw_mem_free(&o->xy);
  pw_mem_free(&o->kept);
  pw_mem_free(&o->tip);
  pw_mem_free(&o->kept_tip);
}

static pw_status outline_create(int n, outline *o)
{
  PW_TRY(pw_mem_alloc("outline", 2 * n, sizeof(pw_real), &o->xy));
  PW_TRY(pw_mem_alloc("outline", 2 * n, sizeof(pw_real), &o->kept));
  PW_TRY(pw_mem_alloc("outline", n, sizeof(bool), &o->tip));
  return pw_mem_alloc("outline", n, sizeof(bool), &o->kept_tip);
}

static pw_status build(const pw_scene *scene, int body, int facing, pw_real segment, int n,
                       outline *o, pw_interface *out)
{
  PW_TRY(outline_create(n, o));
  int count = pw_body_outline(scene, body, segment, o->xy, o->tip, n);
  PW_REQUIRE(count == n, PW_ERR_SCENE, "body %s has no outline", scene->body[body].name);
  bool axi = scene->geometry == PW_AXI;
  part p;
  if (!choose_part(scene, body, facing, &p)) {
    bool closed = !(axi && scene->body[body].shape == PW_SHAPE_PILE);
    return pw_interface_create(o->xy, o->tip, n, closed, axi, GROWTH * n, out);
  }
  count = keep_run(&p, o->xy, o->tip, n, o->kept, o->kept_tip);
  PW_REQUIRE(count >= 2, PW_ERR_SCENE, "body %s has no side that can touch",
             scene->body[body].name);
  return pw_interface_create(o->kept, o->kept_tip, count, false, axi, GROWTH * count, out);
}

pw_status pw_interface_from_body(const pw_scene *scene, int body, int facing, pw_real segment,
                                 pw_real thickness, pw_interface *out)
{
  int n = pw_body_outline(scene, body, segment, NULL, NULL, 0);
  PW_REQUIRE(n >= 2, PW_ERR_SCENE, "body %s has no outline", scene->body[body].name);
  outline o = {0};
  pw_interface line = {0};
  pw_status status = build(scene, body, facing, segment, n, &o, &line);
  outline_destroy(&o);
  PW_TRY(status);
  line.body = body;
  pw_interface_set_mass(&line, thickness * pw_scene_density(scene, body));
  pw_interface_set_velocity(&line, scene->body[body].velocity_m_s);
  *out = line;
  return PW_OK;
}
