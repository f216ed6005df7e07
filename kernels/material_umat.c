/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A user's Abaqus UMAT as a material. The host's duties: stress and total strain are turned with
 * the step before the call (DROT, Hughes and Winget 1980); every call gets copies; what the host
 * does not know is not a number, so that it cannot enter a result unnoticed. A step that the
 * routine does not manage is repeated in halves from the saved state, down to 1/1024; its tangent is
 * then that of the whole step, by differences. */
#include "kernels/umat.h"

#include <math.h>
#include <string.h>

#include "kernels/tensor.h"

enum { WHOLE = 1024 /* smallest pieces in a step */, STIFFNESS = 6 /* state behind STRAN */ };

#define AT(index) ((index) * sizeof(pw_real))
#define ROW(name, type, index, lo, hi, fallback, meaning)                                          \
  {                                                                                                \
    name, type, AT(index), lo, hi, fallback, NULL, NULL, meaning                                   \
  }

static const pw_key keys[] = {
    ROW("library", PW_KEY_FILE, PW_UMAT_FILE, 0, 0, NULL,
        "shared library that holds the routine (Fortran or C)"),
    ROW("symbol", PW_KEY_TEXT, PW_UMAT_SYMBOL, 0, 0, "", "its name; none: umat_ (Fortran) or umat"),
    ROW("cmname", PW_KEY_TEXT, PW_UMAT_NAME, 0, 0, "UMAT", "name of the material told to it"),
    ROW("density_kg_m3", PW_KEY_REAL, PW_UMAT_DENSITY, PW_TINY, PW_HUGE, NULL,
        "density at the start"),
    ROW("nprops", PW_KEY_INT, PW_UMAT_NPROPS, 0, PW_LIST, NULL,
        "number of constants the routine reads (CONSTANTS of *USER MATERIAL)"),
    ROW("props", PW_KEY_REALS, PW_UMAT_PROPS, -PW_HUGE, PW_HUGE, "[]",
        "its constants, in its own order and units; stresses must come out in Pa"),
    ROW("nstatv", PW_KEY_INT, PW_UMAT_NSTATV, 0, PW_UMAT_STATEV, "0",
        "number of its state variables (*DEPVAR)"),
    ROW("statev_initial", PW_KEY_REALS, PW_UMAT_INITIAL, -PW_HUGE, PW_HUGE, "[]",
        "nstatv numbers; none: zeros"),
    ROW("statev_stress_tensors", PW_KEY_REALS, PW_UMAT_STRESS_LIKE, 1, PW_UMAT_STATEV, "[]",
        "first of six state variables that the host turns as a stress (from 1); with such lists "
        "DROT is 1"),
    ROW("statev_strain_tensors", PW_KEY_REALS, PW_UMAT_STRAIN_LIKE, 1, PW_UMAT_STATEV, "[]",
        "first of six state variables that the host turns as a strain (from 1)"),
    ROW("stiffness_bound_pa", PW_KEY_REAL, PW_UMAT_BOUND, 0, PW_HUGE, "0",
        "largest stiffness, for the speed of waves; 0: the largest DDSDDE of each point so far"),
    ROW("element_length_m", PW_KEY_REAL, PW_UMAT_LENGTH, 0, PW_HUGE, "0",
        "CELENT; 0: not a number, for routines that do not use it"),
    ROW("thread_safe", PW_KEY_BOOL, PW_UMAT_THREAD_SAFE, 0, 1, "false",
        "whether several threads may call the routine at once (nothing SAVEd, no COMMON)"),
    {"unchanged_stress", PW_KEY_CHOICE, AT(PW_UMAT_UNCHANGED), 0, 1, "error", "error|accept", NULL,
     "when the stress stays as it is although DDSDDE asks for a change: taken as a lost increment, "
     "or as flow at constant stress"},
    {"ddsdde_measure", PW_KEY_CHOICE, AT(PW_UMAT_MEASURE), 0, 1, "increment", "increment|kirchhoff",
     NULL,
     "what DDSDDE is the derivative of: STRESS by DSTRAN, or J STRESS over J by a strain on top of "
     "DFGRD1, for routines of the deformation gradient"},
    {NULL, PW_KEY_REAL, 0, 0, 0, NULL, NULL, NULL, NULL},
};

#define SDV(n)                                                                                     \
  {                                                                                                \
    "statev_" #n, true                                                                             \
  }
#define SDV5(a, b, c, d, e) SDV(a), SDV(b), SDV(c), SDV(d), SDV(e)
static const pw_state_def states[] = {
    {"umat_strain_11", false}, /* STRAN, engineering shears; - */
    {"umat_strain_22", false},
    {"umat_strain_33", false},
    {"umat_strain_12", false},
    {"umat_strain_13", false},
    {"umat_strain_23", false},
    {"umat_stiffness_pa", false}, /* largest bound of DDSDDE so far */
    SDV5(1, 2, 3, 4, 5),
    SDV5(6, 7, 8, 9, 10),
    SDV5(11, 12, 13, 14, 15),
    SDV5(16, 17, 18, 19, 20),
    SDV5(21, 22, 23, 24, 25),
    SDV5(26, 27, 28, 29, 30),
    SDV5(31, 32, 33, 34, 35),
    SDV5(36, 37, 38, 39, 40),
    SDV5(41, 42, 43, 44, 45),
    SDV5(46, 47, 48, 49, 50),
    SDV5(51, 52, 53, 54, 55),
    SDV(56),
    SDV(57),
    {NULL, false},
};
_Static_assert(sizeof states / sizeof *states == PW_MAX_STATE + 1, "a name for each variable");
_Static_assert((int)PW_UMAT_PARAMS <= (int)PW_MAX_PARAMS, "room for the parameters");

static pw_status check_tensors(const pw_real *param, int list, const char *key)
{
  for (int i = 0; i < (int)param[list]; i++) {
    pw_real first = param[list + 1 + i];
    PW_REQUIRE(first == floor(first) && first >= 1.0 && first + 5.0 <= param[PW_UMAT_NSTATV],
               PW_ERR_SCENE, "%s: six variables from %g on are not among nstatv = %g", key, first,
               param[PW_UMAT_NSTATV]);
  }
  return PW_OK;
}

static pw_status check(const pw_real *v)
{
  PW_REQUIRE(*pw_umat_text(v, PW_UMAT_FILE), PW_ERR_SCENE, "library must name a file");
  PW_REQUIRE(v[PW_UMAT_PROPS] == v[PW_UMAT_NPROPS], PW_ERR_SCENE,
             "props holds %g numbers, but nprops = %g", v[PW_UMAT_PROPS], v[PW_UMAT_NPROPS]);
  PW_REQUIRE(v[PW_UMAT_INITIAL] == 0.0 || v[PW_UMAT_INITIAL] == v[PW_UMAT_NSTATV], PW_ERR_SCENE,
             "statev_initial holds %g numbers, but nstatv = %g", v[PW_UMAT_INITIAL],
             v[PW_UMAT_NSTATV]);
  PW_TRY(check_tensors(v, PW_UMAT_STRESS_LIKE, "statev_stress_tensors"));
  return check_tensors(v, PW_UMAT_STRAIN_LIKE, "statev_strain_tensors");
}

static int nstate(const pw_real *v)
{
  return PW_UMAT_OWN + (int)v[PW_UMAT_NSTATV];
}

static pw_real density(const pw_real *v)
{
  return v[PW_UMAT_DENSITY];
}

static void init(const pw_real *v, pw_idx n, pw_idx ld, const pw_real *stress, pw_real *state)
{
  (void)stress;
  for (int c = 0; c < nstate(v); c++) {
    pw_real start = c >= PW_UMAT_OWN && v[PW_UMAT_INITIAL] > 0.0
                        ? v[PW_UMAT_INITIAL + 1 + c - PW_UMAT_OWN]
                        : 0.0;
    for (pw_idx i = 0; i < n; i++) {
      state[(pw_off)c * ld + i] = start;
    }
  }
}

/** What the points of a batch share. */
typedef struct model {
  const pw_umat *umat;
  const pw_real *param;
  int nstatv;
  bool host_turns;    /* the state's tensors are turned here */
  bool of_f;          /* DDSDDE is by F, of the Kirchhoff stress */
  pw_umat_call blank; /* a call without the point's own numbers */
} model;

/** A point between two calls, in Abaqus' order. */
typedef struct point {
  pw_real stress[6], strain[6], statev[PW_UMAT_STATEV];
  pw_real stiffness;           /* bound of DDSDDE so far; Pa */
  pw_real tangent[36];         /* DDSDDE of the last call */
  pw_real dstrain[6], spin[3]; /* of the whole step */
  pw_real grad[9], f[9];       /* increment of F less 1, F before the step; row-major */
  pw_real x[3];                /* place */
  int32_t number;              /* from 1 */
} point;

/** A part of a step: from a share of it on, so much of it. */
typedef struct part {
  pw_real from, share;
} part;

/* Components of this program (xx yy zz xy yz zx) in Abaqus' order, and back: the same exchange. */
static const int order[6] = {0, 1, 2, 3, 5, 4};

static void prepare(model *m, const pw_real *v, const pw_stress_args *a)
{
  pw_umat_call *c = &m->blank;
  const char *name = pw_umat_text(v, PW_UMAT_NAME);
  *m = (model){.umat = pw_umat_find(pw_umat_text(v, PW_UMAT_FILE), pw_umat_text(v, PW_UMAT_SYMBOL)),
               .param = v,
               .nstatv = (int)v[PW_UMAT_NSTATV],
               .host_turns = v[PW_UMAT_STRESS_LIKE] + v[PW_UMAT_STRAIN_LIKE] > 0.0,
               .of_f = v[PW_UMAT_MEASURE] > 0.5};
  memset(c->cmname, ' ', sizeof c->cmname);
  memcpy(c->cmname, name, strlen(name));
  c->ndi = c->nshr = 3;
  c->ntens = 6;
  c->nstatv = m->nstatv;
  c->nprops = (int32_t)v[PW_UMAT_NPROPS];
  for (int k = 0; k < PW_LIST + PW_UMAT_SPARE; k++) {
    c->props[k] = k < c->nprops ? v[PW_UMAT_PROPS + 1 + k] : (pw_real)NAN;
  }
  for (int k = m->nstatv; k < PW_UMAT_STATEV + PW_UMAT_SPARE; k++) {
    c->statev[k] = (pw_real)NAN;
  }
  c->celent = v[PW_UMAT_LENGTH] > 0.0 ? v[PW_UMAT_LENGTH] : (pw_real)NAN;
  c->noel = c->npt = c->layer = c->kspt = c->kstep[0] = 1;
  c->kinc = a->step < INT32_MAX - 1 ? (int32_t)a->step + 1 : INT32_MAX;
}

/** R a R^T of a tensor in Abaqus' order; @p shear is 1 for stresses, 2 for engineering strains. */
static void turn(const pw_rot *r, pw_real shear, pw_real *a)
{
  const pw_real s = 1.0 / shear;
  pw_t6 t = pw_t6_rotate(*r, (pw_t6){a[0], a[1], a[2], s * a[3], s * a[5], s * a[4]});
  a[0] = t.xx;
  a[1] = t.yy;
  a[2] = t.zz;
  a[3] = shear * t.xy;
  a[4] = shear * t.zx;
  a[5] = shear * t.yz;
}

static void turn_all(const model *m, const pw_rot *r, pw_umat_call *c)
{
  const pw_real *v = m->param, *stresses = v + PW_UMAT_STRESS_LIKE;
  const pw_real *strains = v + PW_UMAT_STRAIN_LIKE;
  const pw_real column[9] = {r->xx, r->yx, r->zx, r->xy, r->yy, r->zy, r->xz, r->yz, r->zz};
  turn(r, 1.0, c->stress);
  turn(r, 2.0, c->stran);
  for (int k = 0; k < (int)stresses[0]; k++) {
    turn(r, 1.0, c->statev + (int)stresses[1 + k] - 1);
  }
  for (int k = 0; k < (int)strains[0]; k++) {
    turn(r, 2.0, c->statev + (int)strains[1 + k] - 1);
  }
  for (int k = 0; k < 9; k++) {
    c->drot[k] = m->host_turns ? (k % 4 == 0 ? 1.0 : 0.0) : column[k];
  }
}

/** F at a share of the step, column-major: (1 + share grad) F. */
static void gradient_at(const point *p, pw_real share, pw_real *out)
{
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      pw_real sum = p->f[3 * i + j];
      for (int k = 0; k < 3; k++) {
        sum += share * p->grad[3 * i + k] * p->f[3 * k + j];
      }
      out[i + 3 * j] = sum;
    }
  }
}

/** The arguments for a part of the step. */
static pw_umat_call arguments(const model *m, const pw_stress_args *a, const point *p, part t)
{
  pw_umat_call c = m->blank;
  pw_rot r = pw_rot_hughes_winget(t.share * p->spin[0], t.share * p->spin[1], t.share * p->spin[2]);
  memcpy(c.stress, p->stress, sizeof c.stress);
  memcpy(c.stran, p->strain, sizeof c.stran);
  memcpy(c.statev, p->statev, (size_t)m->nstatv * sizeof *c.statev);
  turn_all(m, &r, &c);
  for (int k = 0; k < 6; k++) {
    c.dstran[k] = t.share * p->dstrain[k];
  }
  c.dtime = (a->dt > 0.0 ? a->dt : 1e-9) * t.share; /* routines divide by it */
  c.time[0] = c.time[1] = a->time + t.from * a->dt;
  c.pnewdt = 1.0;
  c.noel = p->number;
  memcpy(c.coords, p->x, sizeof c.coords);
  gradient_at(p, t.from, c.dfgrd0);
  gradient_at(p, t.from + t.share, c.dfgrd1);
  return c;
}

/** Advance a point over a part of the step; it is unchanged on failure. */
static const char *advance_part(const model *m, const pw_stress_args *a, point *p, part t,
                                bool *over)
{
  const pw_umat_call sent = arguments(m, a, p, t);
  pw_umat_call c = sent;
  const char *why = m->umat->call(m->umat, &c);
  *over = why != NULL;
  why = why ? why : pw_umat_judge(m->param, &sent, &c, over);
  if (why) {
    return why;
  }
  memcpy(p->stress, c.stress, sizeof p->stress);
  memcpy(p->statev, c.statev, (size_t)m->nstatv * sizeof *p->statev);
  memcpy(p->tangent, c.ddsdde, sizeof p->tangent);
  for (int k = 0; k < 6; k++) {
    p->strain[k] = sent.stran[k] + sent.dstran[k];
  }
  p->stiffness = pw_max(p->stiffness, pw_umat_stiffness(c.ddsdde));
  return NULL;
}

/** The whole step, in halves where the routine asks for them. */
static const char *advance(const model *m, const pw_stress_args *a, point *p, int *pieces)
{
  int done = 0, piece = WHOLE;
  pw_material_counts n = {0};
  while (done < WHOLE) {
    bool over = false;
    part t = {(pw_real)done / WHOLE, (pw_real)piece / WHOLE};
    const char *why = advance_part(m, a, p, t, &over);
    n.rhs++;
    if (why && (over || piece == 1)) {
      return why;
    }
    if (why) {
      piece /= 2;
      n.rejected++;
    } else {
      done += piece;
      n.substeps++;
      piece = done + 2 * piece <= WHOLE && done % (2 * piece) == 0 ? 2 * piece : piece;
    }
  }
  *pieces = (int)n.substeps;
  if (a->counts) {
    a->counts->rhs += n.rhs;
    a->counts->rejected += n.rejected;
    a->counts->substeps += n.substeps;
  }
  return NULL;
}

/** Stress by strain of a step that ended at @p p in pieces: the last DDSDDE knows its piece alone. */
static void differentiate(const model *m, const pw_stress_args *a, const point *start, point *p)
{
  const int at[6] = {0, 4, 8, 1, 2, 5}, back[6] = {0, 4, 8, 3, 6, 7};
  pw_stress_args quiet = *a;
  pw_real size = 1e-4, tangent[36];
  int pieces;
  quiet.counts = NULL;
  for (int k = 0; k < 6; k++) {
    size = pw_max(size, fabs(start->dstrain[k]));
  }
  for (int j = 0; j < 6; j++) {
    const pw_real eta = 1e-6 * size, half = 0.5 * eta;
    point moved = *start;
    moved.dstrain[j] += eta;
    for (int k = 0; m->of_f && k < 3; k++) { /* (1 + e) F */
      moved.grad[at[j] - at[j] % 3 + k] +=
          half * (start->grad[3 * (at[j] % 3) + k] + (at[j] % 3 == k ? 1.0 : 0.0));
      moved.grad[back[j] - back[j] % 3 + k] +=
          half * (start->grad[3 * (back[j] % 3) + k] + (back[j] % 3 == k ? 1.0 : 0.0));
    }
    if (advance(m, &quiet, &moved, &pieces)) {
      return;
    }
    for (int i = 0; i < 6; i++) {
      tangent[i + 6 * j] = (moved.stress[i] - p->stress[i]) / eta;
      tangent[i + 6 * j] += m->of_f && j < 3 ? p->stress[i] : 0.0;
    }
  }
  memcpy(p->tangent, tangent, sizeof tangent);
}

/** F before the step from F after it: (1 + grad)^-1 F, by Cramer's rule. */
static void undo_gradient(const pw_stress_args *a, size_t i, point *p)
{
  const size_t l = (size_t)a->ldi;
  pw_real g[9], inverse[9];
  for (int k = 0; k < 9; k++) {
    g[k] = p->grad[k] + (k % 4 == 0 ? 1.0 : 0.0);
  }
  for (int k = 0; k < 9; k++) {
    int r = (k % 3 + 1) % 3, s = (k % 3 + 2) % 3, u = (k / 3 + 1) % 3, w = (k / 3 + 2) % 3;
    inverse[k] = g[3 * r + u] * g[3 * s + w] - g[3 * r + w] * g[3 * s + u];
  }
  pw_real det = g[0] * inverse[0] + g[1] * inverse[3] + g[2] * inverse[6];
  for (int k = 0; k < 9; k++) {
    pw_real sum = 0.0;
    for (int j = 0; j < 3; j++) {
      sum += inverse[3 * (k / 3) + j] * (a->def_grad ? a->def_grad[(3 * j + k % 3) * l + i] : NAN);
    }
    p->f[k] = sum / det;
  }
}

static void load(const model *m, const pw_stress_args *a, size_t i, point *p)
{
  const size_t l = (size_t)a->ld, li = (size_t)a->ldi;
  const pw_real *d = a->dstrain + i, *w = a->spin + i;
  const pw_real rate[9] = {d[0],     d[3 * li] + w[0],  d[5 * li] - w[2 * li], d[3 * li] - w[0],
                           d[li],    d[4 * li] + w[li], d[5 * li] + w[2 * li], d[4 * li] - w[li],
                           d[2 * li]};
  for (size_t k = 0; k < 6; k++) {
    p->stress[k] = a->stress[(size_t)order[k] * l + i];
    p->dstrain[k] = d[(size_t)order[k] * li] * (k < 3 ? 1.0 : 2.0);
    p->strain[k] = a->state[k * l + i];
  }
  for (size_t k = 0; k < 3; k++) {
    p->spin[k] = w[k * li];
  }
  p->stiffness = a->state[STIFFNESS * l + i];
  for (size_t k = 0; k < (size_t)m->nstatv; k++) {
    p->statev[k] = a->state[(PW_UMAT_OWN + k) * l + i];
  }
  for (size_t k = 0; k < 9; k++) {
    p->grad[k] = a->increment ? a->increment[k * li + i] - (k % 4 == 0 ? 1.0 : 0.0) : rate[k];
  }
  for (int k = 0; k < 3; k++) {
    p->x[k] = !a->x ? (pw_real)NAN : k < a->dim ? a->x[(size_t)k * (size_t)a->ldx + i] : 0.0;
  }
  p->number = a->id ? (int32_t)a->id[i] + 1 : 1;
  undo_gradient(a, i, p);
}

static void store(const model *m, const pw_stress_args *a, size_t i, const point *p)
{
  const size_t l = (size_t)a->ld, li = (size_t)a->ldi;
  for (size_t k = 0; k < 6; k++) {
    a->stress[(size_t)order[k] * l + i] = p->stress[k];
    a->state[k * l + i] = p->strain[k];
  }
  a->state[STIFFNESS * l + i] = p->stiffness;
  for (size_t k = 0; k < (size_t)m->nstatv; k++) {
    a->state[(PW_UMAT_OWN + k) * l + i] = p->statev[k];
  }
  for (size_t row = 0; a->tangent && row < 6; row++) {
    for (size_t col = 0; col < 6; col++) {
      /* d sigma = d tau / J - sigma tr(e) */
      pw_real less = m->of_f && col < 3 ? p->stress[order[row]] : 0.0;
      a->tangent[(6 * row + col) * li + i] = p->tangent[order[row] + 6 * order[col]] - less;
    }
  }
}

static pw_status update(const pw_real *v, pw_stress_args *a)
{
  model m;
  prepare(&m, v, a);
  a->bad = -1;
  a->of_f = m.of_f;
  const bool alone = m.umat && v[PW_UMAT_THREAD_SAFE] < 0.5;
  if (alone) {
    m.umat->enter();
  }
  for (pw_idx i = 0; i < a->n; i++) {
    point p;
    int pieces = 1;
    load(&m, a, (size_t)i, &p);
    const point start = p;
    const char *why =
        m.umat ? advance(&m, a, &p, &pieces) : "the library of the UMAT is not loaded";
    if (!why) {
      if (a->tangent && pieces > 1) {
        differentiate(&m, a, &start, &p);
      }
      store(&m, a, (size_t)i, &p);
    } else if (a->bad < 0) {
      a->bad = i;
      a->why = why;
    }
    pw_real bound = v[PW_UMAT_BOUND] > 0.0 ? v[PW_UMAT_BOUND] : p.stiffness;
    a->wave_speed[i] = sqrt(bound / a->density[i]);
  }
  if (alone) {
    m.umat->leave();
  }
  return a->bad < 0 ? PW_OK : PW_RETRY_STRESS;
}

const pw_material pw_material_umat = {
    .name = "umat",
    .brief = "a user's routine with the interface of the Abaqus UMAT, from a shared library",
    .keys = keys,
    .states = states,
    .needs_def_grad = true,
    .needs_library = true,
    .takes_initial_stress = true,
    .check = check,
    .nstate = nstate,
    .density = density,
    .init = init,
    .update = update,
};
