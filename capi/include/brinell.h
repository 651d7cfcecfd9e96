/* brinell: semi-analytical contact mechanics of real surfaces.
 *
 * Press two bodies together, given the gap between them, their materials and a history of loads; get pressure,
 * contact area, approach and displacement, each with a certificate of its error, and the stress below the surface.
 *
 *   brn_engine  threads, caches and instruction set; one per program is enough, shared by all runs
 *   brn_scene   a description: grid, bodies, surfaces, load history, solver
 *   brn_run     a scene planned on an engine, advanced increment by increment and asked for results
 *   brn_stress_compute  the stress below tractions that the caller already has, without scene and run
 *   brn_return_map_batch  the plastic strain of many points from their trial stress, likewise
 *
 *   brn_engine *engine; brn_scene *scene; brn_run *run;
 *   brn_engine_create(NULL, &engine);
 *   brn_scene_create(&scene);
 *   ... brn_scene_set_grid, brn_scene_set_body, brn_scene_add_shape, brn_scene_add_step ...
 *   brn_run_create(engine, scene, &run);
 *   brn_run_execute(run, NULL, NULL);
 *   brn_run_get_increment(run, 0, &result);
 *
 * Units are SI everywhere: m, N, Pa, rad, s. Surface fields are row-major with x inner: node (i, j) is element
 * j*nx + i and lies at ((i - (nx-1)/2)*dx, (j - (ny-1)/2)*dy). Pressure is positive in compression; it is uniform
 * on the cell around its node. The deformed gap is gap + displacement - approach, plus the plane sx*x + sy*y where
 * the bodies are tilted.
 *
 * Rules of this interface
 *   - Every call that can fail returns a brn_status. A message for a person, which names the argument, its value and
 *     what is allowed, is kept per handle and thread (brn_engine_message, ...), or per thread where there is no
 *     handle yet (brn_last_message).
 *   - A create call sets *out to NULL on failure. Destroying NULL does nothing. No exception, abort or exit crosses
 *     this interface.
 *   - Option structs begin with struct_size. Initialise them with their brn_..._init function, which is compiled into
 *     the caller and so fills in the caller's size, and the defaults. Members are only ever appended; the engine
 *     reads those that struct_size covers and uses the defaults for the others, and writes only those of a result
 *     that struct_size covers.
 *   - The caller owns all arrays; they are borrowed for the duration of the call.
 *   - An engine may be used from several threads at once. A scene or run is used by one thread at a time; a second
 *     one gets BRN_WRONG_STATE. Distinct runs work concurrently on one engine.
 *   - Same build, same instruction set: the same bits, whatever the number of threads, from process to process.
 */
#ifndef BRINELL_H
#define BRINELL_H

#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
#define BRN_API
#else
#define BRN_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---------------------------------------------------------------- status */

typedef int32_t brn_status;

enum {
  BRN_OK = 0,
  BRN_INVALID_ARGUMENT = 10, /* NULL, out of range, not finite, unknown constant */
  BRN_INVALID_SCENE = 20,    /* the parts are valid, but do not fit together or are incomplete */
  BRN_WRONG_STATE = 30,      /* call out of order, or the handle is in use by another thread */
  BRN_SHORT_BUFFER = 40,     /* the caller's array is too small; the needed size is reported */
  BRN_UNSUPPORTED = 50,      /* this machine or build cannot do it */
  BRN_OUT_OF_MEMORY = 60,    /* an allocation failed */
  BRN_TOO_LARGE = 70,        /* refused by the plan: more memory than is allowed */
  BRN_NOT_CONVERGED = 80,    /* the certificate stays above the tolerance; the result is kept and marked */
  BRN_NO_EQUILIBRIUM = 85,   /* no state of contact can carry the load */
  BRN_CANCELLED = 90,        /* the progress callback asked to stop; the run can go on or be saved */
  BRN_DAMAGED_DATA = 100,    /* a saved run is truncated, altered, or belongs to another scene */
  BRN_INTERNAL = 1000        /* a defect of brinell: please report the message */
};

/* "BRN_OK", "BRN_INVALID_ARGUMENT", ...; "unknown status" for other values. Never NULL. */
BRN_API const char *brn_status_name(brn_status status);

/* Message of this thread's last failed call that had no handle to keep it (create calls, NULL handles); "" if none.
 * Valid until this thread's next such failure. */
BRN_API const char *brn_last_message(void);

/* Release of the library, "major.minor.patch". */
BRN_API const char *brn_version(void);

/* ---------------------------------------------------------------- engine */

typedef struct brn_engine brn_engine;

enum { BRN_ISA_BEST = 0, BRN_ISA_BASELINE = 1, BRN_ISA_AVX2 = 2, BRN_ISA_AVX512 = 3 };

typedef struct brn_engine_options {
  size_t struct_size;
  int32_t threads;       /* 0: what the caller itself may use; else at most this many, at most 1024 */
  int32_t isa;           /* BRN_ISA_...: a set that the machine lacks is BRN_UNSUPPORTED */
  const char *wisdom;    /* NUL-terminated text of brn_engine_export_wisdom, or NULL: plans by estimate */
  uint64_t memory_limit; /* bytes that one run may plan; 0: the machine's memory */
  uint64_t cache_limit;  /* bytes of influence coefficients kept for later runs; 0: a quarter of memory_limit */
} brn_engine_options;

static inline void brn_engine_options_init(brn_engine_options *value) {
  value->struct_size = sizeof *value;
  value->threads = 0;
  value->isa = 0;
  value->wisdom = NULL;
  value->memory_limit = 0;
  value->cache_limit = 0;
}

/* options may be NULL: the defaults. */
BRN_API brn_status brn_engine_create(const brn_engine_options *options, brn_engine **out);

/* Destroy the engine's runs first. */
BRN_API void brn_engine_destroy(brn_engine *engine);

/* Message of this thread's last failed call on the engine; "" if none. Valid until its next one. */
BRN_API const char *brn_engine_message(const brn_engine *engine);

/* Instruction set in use, BRN_ISA_BASELINE or higher, and its name; 0 and "" for NULL. */
BRN_API int32_t brn_engine_isa(const brn_engine *engine);
BRN_API const char *brn_engine_isa_name(const brn_engine *engine);

/* Number of threads that the engine may use; 0 for NULL. */
BRN_API int32_t brn_engine_threads(const brn_engine *engine);

/* Writes the accumulated plans of the Fourier transforms as text, NUL included, for brn_engine_options.wisdom.
 * *size receives the bytes needed; buffer may be NULL if capacity is 0. */
BRN_API brn_status brn_engine_export_wisdom(brn_engine *engine, char *buffer, size_t capacity, size_t *size);

/* ---------------------------------------------------------------- scene */

typedef struct brn_scene brn_scene;

BRN_API brn_status brn_scene_create(brn_scene **out);
BRN_API void brn_scene_destroy(brn_scene *scene);
BRN_API const char *brn_scene_message(const brn_scene *scene);

enum { BRN_BOUNDARY_FREE = 0, BRN_BOUNDARY_PERIODIC = 1 };

typedef struct brn_grid {
  size_t struct_size;
  int64_t nx, ny;   /* nodes, >= 1 */
  double dx, dy;    /* spacing [m], > 0 */
  int32_t boundary; /* BRN_BOUNDARY_...; periodic: the mean displacement is zero, so approach is measured from the
                       mean plane of the deformed surface */
  int32_t reserved;
} brn_grid;

static inline void brn_grid_init(brn_grid *value) {
  value->struct_size = sizeof *value;
  value->nx = 0;
  value->ny = 0;
  value->dx = 0.0;
  value->dy = 0.0;
  value->boundary = 0;
  value->reserved = 0;
}

/* Before any surface of heights is added; a scene's grid cannot change once it holds one. */
BRN_API brn_status brn_scene_set_grid(brn_scene *scene, const brn_grid *grid);

enum { BRN_BODY_DEFAULT = -1, BRN_LOWER = 0, BRN_UPPER = 1 };

typedef struct brn_body {
  size_t struct_size;
  double youngs_modulus; /* [Pa] > 0; ignored if rigid */
  double poissons_ratio; /* -1 < nu < 0.5; ignored if rigid */
  int32_t rigid;         /* 0 or 1 */
  int32_t reserved;
} brn_body;

static inline void brn_body_init(brn_body *value) {
  value->struct_size = sizeof *value;
  value->youngs_modulus = 0.0;
  value->poissons_ratio = 0.0;
  value->rigid = 1;
  value->reserved = 0;
}

/* Both bodies are rigid until set; a run needs at least one that is not. */
BRN_API brn_status brn_scene_set_body(brn_scene *scene, int32_t which, const brn_body *body);

enum {
  BRN_SHAPE_PLANE = 0,
  BRN_SHAPE_SPHERE = 1,     /* radius */
  BRN_SHAPE_ELLIPSOID = 2,  /* radius_x, radius_y */
  BRN_SHAPE_CONE = 3,       /* half_angle from the axis, tip_radius (0: sharp) */
  BRN_SHAPE_FLAT_PUNCH = 4, /* radius of the flat, edge_radius */
  BRN_SHAPE_ROLLER = 5,     /* axis along x: radius across it, straight_length, crown_radius beyond */
  BRN_SHAPE_SINUSOID = 6    /* amplitude, wavelength_x, wavelength_y (0: constant in that direction) */
};

enum { BRN_PROFILE_PARABOLIC = 0, BRN_PROFILE_EXACT = 1 };

/* Surfaces say whose they are, which matters where brn_step.offset moves the upper body. BRN_BODY_DEFAULT: spheres,
 * ellipsoids, cones, punches and rollers are the upper body's; planes, sinusoids, roughness and heights the lower
 * one's. */

/* Each shape is zero at its apex, above the grid's centre, and grows outwards. */
typedef struct brn_shape {
  size_t struct_size;
  int32_t kind;    /* BRN_SHAPE_... */
  int32_t profile; /* BRN_PROFILE_...: sphere, ellipsoid, roller */
  double radius, radius_x, radius_y;
  double half_angle, tip_radius;
  double edge_radius;
  double straight_length, crown_radius;
  double amplitude, wavelength_x, wavelength_y;
  int32_t body; /* BRN_BODY_DEFAULT, BRN_LOWER or BRN_UPPER */
  int32_t reserved;
} brn_shape;

static inline void brn_shape_init(brn_shape *value) {
  value->struct_size = sizeof *value;
  value->kind = BRN_SHAPE_PLANE;
  value->profile = BRN_PROFILE_PARABOLIC;
  value->radius = 0.0;
  value->radius_x = 0.0;
  value->radius_y = 0.0;
  value->half_angle = 0.0;
  value->tip_radius = 0.0;
  value->edge_radius = 0.0;
  value->straight_length = 0.0;
  value->crown_radius = 0.0;
  value->amplitude = 0.0;
  value->wavelength_x = 0.0;
  value->wavelength_y = 0.0;
  value->body = BRN_BODY_DEFAULT;
  value->reserved = 0;
}

/* The gap is the sum of all shapes minus all heights. */
BRN_API brn_status brn_scene_add_shape(brn_scene *scene, const brn_shape *shape);

/* Self-affine roughness: heights whose power spectrum is constant between the wavelengths long_cutoff and rolloff,
 * falls as |q|^(-2-2*hurst) down to short_cutoff, and vanishes outside. The same parameters and seed give the same
 * bits on every machine. */
typedef struct brn_roughness {
  size_t struct_size;
  double hurst;        /* 0 < hurst <= 1 */
  double rms_slope;    /* exactly one of rms_slope and */
  double rms_height;   /* rms_height [m] is positive, the other zero */
  double long_cutoff;  /* [m]; 0: the longer side of the grid */
  double rolloff;      /* [m]; 0: long_cutoff */
  double short_cutoff; /* [m]; 0: twice the larger spacing */
  uint64_t seed;
  int32_t body; /* BRN_BODY_DEFAULT, BRN_LOWER or BRN_UPPER */
  int32_t reserved;
} brn_roughness;

static inline void brn_roughness_init(brn_roughness *value) {
  value->struct_size = sizeof *value;
  value->hurst = 0.0;
  value->rms_slope = 0.0;
  value->rms_height = 0.0;
  value->long_cutoff = 0.0;
  value->rolloff = 0.0;
  value->short_cutoff = 0.0;
  value->seed = 0;
  value->body = BRN_BODY_DEFAULT;
  value->reserved = 0;
}
BRN_API brn_status brn_scene_add_roughness(brn_scene *scene, const brn_roughness *roughness);

enum { BRN_DETREND_NONE = 0, BRN_DETREND_MEAN = 1, BRN_DETREND_PLANE = 2 };

/* Heights of a measured surface [m]: a peak is positive and reduces the gap. Node (i, j) is
 * values[i*stride_x + j*stride_y]; strides are counted in doubles. */
typedef struct brn_heights {
  size_t struct_size;
  const double *values;
  int64_t nx, ny;             /* must be the grid's */
  int64_t stride_x, stride_y; /* 0: contiguous, 1 and nx */
  int32_t detrend;            /* BRN_DETREND_... */
  int32_t reserved;
  int32_t body; /* of a scene: BRN_BODY_DEFAULT, BRN_LOWER or BRN_UPPER */
  int32_t reserved2;
} brn_heights;

static inline void brn_heights_init(brn_heights *value) {
  value->struct_size = sizeof *value;
  value->values = NULL;
  value->nx = 0;
  value->ny = 0;
  value->stride_x = 0;
  value->stride_y = 0;
  value->detrend = 0;
  value->reserved = 0;
  value->body = BRN_BODY_DEFAULT;
  value->reserved2 = 0;
}

/* Copies the heights. NaN and infinity are refused with their index. */
BRN_API brn_status brn_scene_add_heights(brn_scene *scene, const brn_heights *heights);

/* Height statistics of ISO 25178-2, each about the mean plane through zero mean height. */
typedef struct brn_statistics {
  size_t struct_size;
  double sa, sq;     /* arithmetic and root mean square height [m] */
  double ssk, sku;   /* skewness and kurtosis */
  double sp, sv, sz; /* highest peak, deepest valley, their sum [m] */
  double sdq;        /* root mean square gradient */
} brn_statistics;

static inline void brn_statistics_init(brn_statistics *value) {
  value->struct_size = sizeof *value;
  value->sa = 0.0;
  value->sq = 0.0;
  value->ssk = 0.0;
  value->sku = 0.0;
  value->sp = 0.0;
  value->sv = 0.0;
  value->sz = 0.0;
  value->sdq = 0.0;
}

/* Statistics of a caller's heights on spacing dx, dy [m]. */
BRN_API brn_status brn_height_statistics(const brn_heights *heights, double dx, double dy, brn_statistics *out);

enum { BRN_DRIVE_FORCE = 1, BRN_DRIVE_APPROACH = 2, BRN_DRIVE_MEAN_PRESSURE = 3 };

enum {
  BRN_ROTATION_FIXED = 0, /* the slopes are brn_step.tilt: parallel unless set */
  BRN_ROTATION_FREE = 1   /* the slopes follow from brn_step.eccentricity, where the force acts */
};

/* One leg of the load history: from the state before it to `target` in equal increments. The first leg starts from
 * zero force, or from the approach min(0, first touch). Where the force acts, or the slopes, are the step's own from
 * its first increment on.
 *
 * The bodies stay parallel unless a step says otherwise: to press beside the centre,
 *   step.rotation = BRN_ROTATION_FREE; step.eccentricity[0] = 1e-3;
 * and brn_increment.tilt tells how they turned. A force at the centre keeps only symmetric bodies parallel when they
 * may rotate. BRN_NO_EQUILIBRIUM: no contact can carry the force where it acts.
 *
 * A step with an offset first moves the upper body sideways, from where it stood; offsets add up. Without friction
 * only the places matter, so bodies may move while they are in contact, which is then solved anew. What is known by a
 * formula moves by any way; roughness, heights and the cuboids of an upper body that hardens by whole nodes, so that
 * the offsets must add up to multiples of the spacing (but for rounding, 1e-9 of it). Formulas and heights come back
 * on the other side of a periodic boundary; on a free one heights of the upper body cannot move, because nothing is
 * known of what would move into the grid, and plastic strain cannot leave it. All places of a run's results stay
 * those of the grid. */
typedef struct brn_step {
  size_t struct_size;
  int32_t drive;            /* BRN_DRIVE_...: mean pressure on periodic grids only */
  int32_t increments;       /* >= 1 */
  double target;            /* N >= 0, m, or Pa >= 0 */
  double traction_ratio[2]; /* full sliding: shear along x and y on the lower body, as multiples of the pressure; the
                               upper body gets the opposite. Enters the stress below the surface, and with it what
                               yields; the displacement that it causes is left out of the contact */
  int32_t rotation;         /* BRN_ROTATION_...; periodic grids cannot rotate */
  int32_t reserved;
  double eccentricity[2]; /* with free rotation: centre of the pressure, x and y [m] from the grid's centre, within
                             its nodes, wherever the upper body has moved. With a prescribed approach the force
                             follows */
  double tilt[2];         /* with fixed rotation: slopes sx, sy [rad]; the deformed gap is
                             gap + displacement - approach + sx*x + sy*y, approach being at the grid's centre */
  double offset[2];       /* by which the upper body moves along x and y before the step [m] */
} brn_step;

static inline void brn_step_init(brn_step *value) {
  value->struct_size = sizeof *value;
  value->drive = 0;
  value->increments = 1;
  value->target = 0.0;
  value->traction_ratio[0] = 0.0;
  value->traction_ratio[1] = 0.0;
  value->rotation = BRN_ROTATION_FIXED;
  value->reserved = 0;
  value->eccentricity[0] = 0.0;
  value->eccentricity[1] = 0.0;
  value->tilt[0] = 0.0;
  value->tilt[1] = 0.0;
  value->offset[0] = 0.0;
  value->offset[1] = 0.0;
}
BRN_API brn_status brn_scene_add_step(brn_scene *scene, const brn_step *step);

enum { BRN_PRECISION_DOUBLE = 0, BRN_PRECISION_MIXED = 1 };

typedef struct brn_solver {
  size_t struct_size;
  double tolerance;       /* on the certificate, 1e-14 ... 0.1; default 1e-8 */
  int32_t max_iterations; /* per increment; default 2000 */
  int32_t precision;      /* BRN_PRECISION_... */
  /* Where a body hardens: an increment is divided until the estimate brn_increment.increment_error of each part is no
     larger, into 256 parts at most; 1e-6 ... 1, or 0: increments are as the step says. Default 0. */
  double increment_tolerance;
} brn_solver;

static inline void brn_solver_init(brn_solver *value) {
  value->struct_size = sizeof *value;
  value->tolerance = 1e-8;
  value->max_iterations = 2000;
  value->precision = 0;
  value->increment_tolerance = 0.0;
}
BRN_API brn_status brn_scene_set_solver(brn_scene *scene, const brn_solver *solver);

/* What is wanted of the stress below the surfaces; without it none is computed. Each body has its own frame: x and y
 * are the grid's, z is zero at its surface and points into it. In the upper body's frame xz and yz stresses have the
 * opposite sign of what they have in the lower body's axes. */
typedef struct brn_subsurface {
  size_t struct_size;
  int64_t layers;         /* equal layers, at the depths (k + 1/2) * layer_thickness, k = 0 ... layers-1; */
  double layer_thickness; /* [m] > 0 */
  const double *depths;   /* or, with layers = 0, these depths [m]: rising, zero is the surface itself */
  size_t depth_count;
  const int32_t *fields; /* BRN_FIELD_STRESS and those after it, which the run then holds for its last increment */
  size_t field_count;
  int32_t max_von_mises;       /* 0 or 1: the largest von Mises stress and its place, which need no field. Fields of
                                  the stress or the von Mises stress bring them along */
  int32_t upper_max_von_mises; /* 0 or 1: the same of the upper body */
} brn_subsurface;

static inline void brn_subsurface_init(brn_subsurface *value) {
  value->struct_size = sizeof *value;
  value->layers = 0;
  value->layer_thickness = 0.0;
  value->depths = NULL;
  value->depth_count = 0;
  value->fields = NULL;
  value->field_count = 0;
  value->max_von_mises = 0;
  value->upper_max_von_mises = 0;
}

/* Copies depths and fields; the last call holds. A rigid body has no stress: asking for it makes the scene
 * BRN_INVALID_SCENE for a run. */
BRN_API brn_status brn_scene_set_subsurface(brn_scene *scene, const brn_subsurface *subsurface);

/* ---------------------------------------------------------------- run */

typedef struct brn_run brn_run;

/* Checks the scene as a whole and plans it; copies what it needs, so that the scene may be changed or destroyed
 * afterwards. Allocates no fields yet. The engine must outlive the run. */
BRN_API brn_status brn_run_create(brn_engine *engine, const brn_scene *scene, brn_run **out);
BRN_API void brn_run_destroy(brn_run *run);
BRN_API const char *brn_run_message(const brn_run *run);

/* One line of the plan: a stage, what it holds or carries out, and the bytes that takes. */
typedef struct brn_plan_item {
  size_t struct_size;
  const char *stage; /* "surface", "contact", "plastic", "stress"; lives as long as the run */
  const char *what;
  uint64_t bytes;
} brn_plan_item;

static inline void brn_plan_item_init(brn_plan_item *value) {
  value->struct_size = sizeof *value;
  value->stage = NULL;
  value->what = NULL;
  value->bytes = 0;
}

BRN_API int32_t brn_run_plan_count(const brn_run *run);
BRN_API brn_status brn_run_get_plan_item(brn_run *run, int32_t index, brn_plan_item *out);

/* Bytes of all items: the most that the run holds at one time, shared coefficients included. */
BRN_API uint64_t brn_run_memory_bytes(const brn_run *run);

typedef struct brn_progress {
  size_t struct_size;
  int32_t step, increment; /* being solved */
  int32_t solved, total;   /* increments of the run */
  int32_t iteration;       /* on the full grid, in this increment */
  int32_t reserved;
  double estimate; /* of the certificate */
  double seconds;  /* since the increment began */
} brn_progress;

/* Called on the thread that called brn_run_advance or brn_run_execute, never concurrently. Return 0 to go on; any
 * other value cancels: the state goes back to the last solved increment. */
typedef int32_t (*brn_progress_callback)(const brn_progress *progress, void *user);

/* Solves the next increment. BRN_NOT_CONVERGED: its result is kept and marked, and the run may go on.
 * BRN_WRONG_STATE: there is no further increment. callback may be NULL. An increment whose contact is solved stays
 * solved when its stress is then cancelled or fails: it is marked stress_missing, and the next call computes the
 * stress before anything else and returns. */
BRN_API brn_status brn_run_advance(brn_run *run, brn_progress_callback callback, void *user);

/* Solves all remaining increments, and a stress that is missing; stops at the first that does not end in BRN_OK. */
BRN_API brn_status brn_run_execute(brn_run *run, brn_progress_callback callback, void *user);

BRN_API int32_t brn_run_total_increments(const brn_run *run);
BRN_API int32_t brn_run_solved_increments(const brn_run *run);

/* Result of one solved increment. NaN where the scene leaves a quantity out or it does not exist (the centre of
 * no force). */
typedef struct brn_increment {
  size_t struct_size;
  int32_t step, increment;
  int32_t converged;    /* 0 or 1 */
  int32_t iterations;   /* on the full grid */
  int32_t convolutions; /* on the full grid, the certificate's included */
  int32_t reserved;
  int64_t contact_nodes;
  double normal_force;       /* [N] */
  double approach;           /* [m] */
  double tilt[2];            /* slopes sx, sy [rad] of the plane that is added to the gap */
  double centre_of_force[2]; /* [m] */
  double first_touch;  /* smallest gap of the surfaces without pressure, with what plastic strain has left [m] */
  double contact_area; /* [m^2] */
  double max_pressure; /* [Pa] */
  double max_pressure_at[2]; /* [m] */
  double mean_gap;           /* of the deformed surfaces, over the grid [m] */
  /* The certificate, recomputed from the final pressure with a fresh convolution: */
  double penetration;     /* largest interpenetration / largest displacement */
  double complementarity; /* sum p*|gap| / (sum p * largest displacement) */
  double tension;         /* largest tensile / largest compressive pressure */
  double balance;         /* |force - prescribed force| / prescribed force; with free rotation also of the moments,
                             relative to force * half the grid, and of a prescribed approach: the worst of them */
  double wall_seconds;
  /* Largest von Mises stress [Pa] and its x, y, z [m] in the body's own frame, both interpolated between nodes and
     depths: */
  double max_von_mises, max_von_mises_at[3];
  double upper_max_von_mises, upper_max_von_mises_at[3];
  int32_t stress_missing; /* 0; 1: its stress was cancelled or failed, and the next brn_run_advance computes it */
  int32_t reserved2;
  /* Of bodies that harden; NaN and 0 for others: */
  double yield; /* entry of the certificate: worst violation of the yield condition by the total stress, in cuboids
                   that flow its distance from it, relative to the yield stress */
  int32_t substeps; /* parts in which the increment was solved: 1 unless it did not converge as a whole, or
                       brn_solver.increment_tolerance asks for more */
  int32_t reserved3;
  double max_equivalent_plastic_strain;
  double max_equivalent_plastic_strain_at[3]; /* centre of its cuboid, in the body's own frame [m] */
  int64_t plastic_nodes;                      /* cuboids that have flowed */
  double upper_max_equivalent_plastic_strain;
  double upper_max_equivalent_plastic_strain_at[3];
  int64_t upper_plastic_nodes;
  double offset[2]; /* where the upper body stands, from where it began: the steps' offsets so far, summed [m] */
  double increment_error; /* estimate of what the size of the increment, the worst of its parts, is wrong by: the
                             stress that the error of the plastic strain makes, relative to the yield stress, as root
                             mean square over the cuboids that have flowed. In proportion to the square of the size */
} brn_increment;

static inline void brn_increment_init(brn_increment *value) {
  value->struct_size = sizeof *value;
  value->step = 0;
  value->increment = 0;
  value->converged = 0;
  value->iterations = 0;
  value->convolutions = 0;
  value->reserved = 0;
  value->contact_nodes = 0;
  value->normal_force = 0.0;
  value->approach = 0.0;
  value->tilt[0] = 0.0;
  value->tilt[1] = 0.0;
  value->centre_of_force[0] = 0.0;
  value->centre_of_force[1] = 0.0;
  value->first_touch = 0.0;
  value->contact_area = 0.0;
  value->max_pressure = 0.0;
  value->max_pressure_at[0] = 0.0;
  value->max_pressure_at[1] = 0.0;
  value->mean_gap = 0.0;
  value->penetration = 0.0;
  value->complementarity = 0.0;
  value->tension = 0.0;
  value->balance = 0.0;
  value->wall_seconds = 0.0;
  value->max_von_mises = 0.0;
  value->max_von_mises_at[0] = 0.0;
  value->max_von_mises_at[1] = 0.0;
  value->max_von_mises_at[2] = 0.0;
  value->upper_max_von_mises = 0.0;
  value->upper_max_von_mises_at[0] = 0.0;
  value->upper_max_von_mises_at[1] = 0.0;
  value->upper_max_von_mises_at[2] = 0.0;
  value->stress_missing = 0;
  value->reserved2 = 0;
  value->yield = 0.0;
  value->substeps = 0;
  value->reserved3 = 0;
  value->max_equivalent_plastic_strain = 0.0;
  value->max_equivalent_plastic_strain_at[0] = 0.0;
  value->max_equivalent_plastic_strain_at[1] = 0.0;
  value->max_equivalent_plastic_strain_at[2] = 0.0;
  value->plastic_nodes = 0;
  value->upper_max_equivalent_plastic_strain = 0.0;
  value->upper_max_equivalent_plastic_strain_at[0] = 0.0;
  value->upper_max_equivalent_plastic_strain_at[1] = 0.0;
  value->upper_max_equivalent_plastic_strain_at[2] = 0.0;
  value->upper_plastic_nodes = 0;
  value->offset[0] = 0.0;
  value->offset[1] = 0.0;
  value->increment_error = 0.0;
}
BRN_API brn_status brn_run_get_increment(brn_run *run, int32_t index, brn_increment *out);

/* One point of error against run time. */
typedef struct brn_trace_point {
  size_t struct_size;
  int32_t step, increment;
  int32_t iteration;
  int32_t certified; /* 1: recomputed with a fresh convolution; 0: the iteration's own estimate */
  int64_t nx, ny;    /* grid of the iteration: coarser ones prepare the start */
  double seconds;    /* since the run began */
  double certificate;
} brn_trace_point;

static inline void brn_trace_point_init(brn_trace_point *value) {
  value->struct_size = sizeof *value;
  value->step = 0;
  value->increment = 0;
  value->iteration = 0;
  value->certified = 0;
  value->nx = 0;
  value->ny = 0;
  value->seconds = 0.0;
  value->certificate = 0.0;
}

BRN_API int64_t brn_run_trace_count(const brn_run *run);
BRN_API brn_status brn_run_get_trace_point(brn_run *run, int64_t index, brn_trace_point *out);

/* Seconds spent in a stage of the plan so far; index as in brn_run_stage_name, which returns NULL past the end. */
BRN_API const char *brn_run_stage_name(const brn_run *run, int32_t index);
BRN_API double brn_run_stage_seconds(const brn_run *run, int32_t index);

enum {
  BRN_FIELD_PRESSURE = 1,       /* [Pa] */
  BRN_FIELD_GAP = 2,            /* of the deformed surfaces [m] */
  BRN_FIELD_DISPLACEMENT = 3,   /* normal, of both bodies together [m] */
  BRN_FIELD_UNDEFORMED_GAP = 4, /* with the upper body where it stands [m]; known before the first increment */
  /* Displacement of the surface that plastic strain alone leaves [m], positive into the body; where that body
     hardens: */
  BRN_FIELD_RESIDUAL_DISPLACEMENT = 10,
  BRN_FIELD_UPPER_RESIDUAL_DISPLACEMENT = 110,
  /* Below the lower body's surface [Pa], tension positive; only those that brn_subsurface.fields names: */
  BRN_FIELD_STRESS = 20, /* xx yy zz yz xz xy of each node, side by side; with the residual stress */
  BRN_FIELD_VON_MISES = 21,
  BRN_FIELD_TRESCA = 22,      /* the largest principal stress less the smallest */
  BRN_FIELD_HYDROSTATIC = 23, /* mean of the normal stresses, negative under pressure */
  BRN_FIELD_PRINCIPAL_1 = 24, /* the largest */
  BRN_FIELD_PRINCIPAL_2 = 25,
  BRN_FIELD_PRINCIPAL_3 = 26,
  BRN_FIELD_PRINCIPAL_DIRECTIONS = 27, /* unit vectors of principal stresses 1 to 3, one after the other: nine numbers
                                          of each node, side by side, [-]; their signs have no meaning */
  BRN_FIELD_PLASTIC_STRAIN = 30,       /* tensor components, six numbers as of the stress */
  BRN_FIELD_EQUIVALENT_PLASTIC_STRAIN = 31,
  BRN_FIELD_RESIDUAL_STRESS = 32, /* that of the plastic strain alone [Pa], six numbers */
  /* Below the upper body's surface: */
  BRN_FIELD_UPPER_STRESS = 120,
  BRN_FIELD_UPPER_VON_MISES = 121,
  BRN_FIELD_UPPER_TRESCA = 122,
  BRN_FIELD_UPPER_HYDROSTATIC = 123,
  BRN_FIELD_UPPER_PRINCIPAL_1 = 124,
  BRN_FIELD_UPPER_PRINCIPAL_2 = 125,
  BRN_FIELD_UPPER_PRINCIPAL_3 = 126,
  BRN_FIELD_UPPER_PRINCIPAL_DIRECTIONS = 127,
  BRN_FIELD_UPPER_PLASTIC_STRAIN = 130,
  BRN_FIELD_UPPER_EQUIVALENT_PLASTIC_STRAIN = 131,
  BRN_FIELD_UPPER_RESIDUAL_STRESS = 132
};

/* Copies a field of the last solved increment: nx*ny doubles on the surface; below it layers*ny*nx, element
 * (layer*ny + j)*nx + i, each of a tensor six numbers, of directions nine. *count receives the number needed; values
 * may be NULL if capacity is 0 (that returns BRN_OK: a query of the size). A run that was loaded, or whose stress is
 * missing, computes it here. BRN_WRONG_STATE: the scene does not ask for this field. */
BRN_API brn_status brn_run_get_field(brn_run *run, int32_t field, double *values, size_t capacity, size_t *count);

/* The same for one layer of a field below the surface, counted from the uppermost: nx*ny doubles, six times as many
 * of the stress, nine times of directions. */
BRN_API brn_status brn_run_get_layer(brn_run *run, int32_t field, int64_t layer, double *values, size_t capacity,
                                     size_t *count);

/* Depths of the layers [m]; none if the scene asks for no stress. Sizes as in brn_run_get_field. */
BRN_API brn_status brn_run_get_depths(brn_run *run, double *depths, size_t capacity, size_t *count);

/* Writes the run's state (all solved increments, and what the next ones start from) to the caller's memory. *size
 * receives the bytes needed; buffer may be NULL if capacity is 0 (a query of the size). */
BRN_API brn_status brn_run_save(brn_run *run, void *buffer, size_t capacity, size_t *size);

/* A run that goes on where a saved one stopped, to the same bits. The scene must be the one it was saved from. */
BRN_API brn_status brn_run_load(brn_engine *engine, const brn_scene *scene, const void *data, size_t size,
                                brn_run **out);

/* ---------------------------------------------------------------- benchmark
 *
 * Seconds mean little on a shared machine. Each kernel of the engine therefore has a calibration: work of the same
 * kind that is not the engine's own. Run both in turn, round after round, and watch the ratio of their times: its
 * median stays where it is until the kernel itself changes. */

/* Kernels and calibrations together; their indices are 0 to this less one. */
BRN_API int32_t brn_benchmark_count(void);

/* For example "convolution_double"; NULL for an index that does not exist. The names, not the indices, stay the same
 * in later releases. */
BRN_API const char *brn_benchmark_name(int32_t index);

/* Index of the calibration that belongs to a kernel; that of a calibration is its own; -1 for an index that does not
 * exist. Calibration 0 suits whole runs. */
BRN_API int32_t brn_benchmark_calibration(int32_t index);

/* Carries one out on the engine, once to warm up and then for some ten milliseconds. *seconds receives what one turn
 * took: processor time of the calling thread if the engine has one thread, else wall time. */
BRN_API brn_status brn_benchmark_run(brn_engine *engine, int32_t index, double *seconds);

/* ---------------------------------------------------------------- stress */

/* Tractions that the caller already has, on a grid of its own: the stress below them needs no scene and no run. */
typedef struct brn_stress_request {
  size_t struct_size;
  int64_t nx, ny;        /* nodes, >= 1 */
  double dx, dy;         /* spacing [m], > 0 */
  int32_t boundary;      /* BRN_BOUNDARY_... */
  int32_t body;          /* BRN_LOWER or BRN_UPPER: whose frame, and who gets the shears with the opposite sign */
  double poissons_ratio; /* -1 < nu < 0.5 */
  const double *depths;  /* [m] rising, zero is the surface; at least one */
  size_t depth_count;
  const double *pressure; /* nx*ny doubles each [Pa]; NULL: none of this kind, but one is needed. Pressure presses, */
  const double *shear_x;  /* a shear > 0 pushes the lower body's surface along +x */
  const double *shear_y;  /* or +y */
} brn_stress_request;

static inline void brn_stress_request_init(brn_stress_request *value) {
  value->struct_size = sizeof *value;
  value->nx = 0;
  value->ny = 0;
  value->dx = 0.0;
  value->dy = 0.0;
  value->boundary = 0;
  value->body = 0;
  value->poissons_ratio = 0.0;
  value->depths = NULL;
  value->depth_count = 0;
  value->pressure = NULL;
  value->shear_x = NULL;
  value->shear_y = NULL;
}

enum { BRN_XX = 0, BRN_YY = 1, BRN_ZZ = 2, BRN_YZ = 3, BRN_XZ = 4, BRN_XY = 5 };

/* Where results go: NULL is neither wanted nor computed. Each array has depth_count*ny*nx doubles, element
 * (layer*ny + j)*nx + i, in Pa with tension positive. */
typedef struct brn_stress_fields {
  size_t struct_size;
  size_t capacity;      /* doubles in each array that is not NULL */
  double *component[6]; /* BRN_XX ... BRN_XY */
  double *von_mises;
  double *tresca;       /* the largest principal stress less the smallest */
  double *hydrostatic;  /* mean of the normal stresses */
  double *principal[3]; /* falling */
  double *direction[9]; /* [3*k + axis] of principal stress k: unit vectors of either sign; all nine or none */
} brn_stress_fields;

static inline void brn_stress_fields_init(brn_stress_fields *value) {
  int k;
  value->struct_size = sizeof *value;
  value->capacity = 0;
  for (k = 0; k < 6; ++k) value->component[k] = NULL;
  value->von_mises = NULL;
  value->tresca = NULL;
  value->hydrostatic = NULL;
  for (k = 0; k < 3; ++k) value->principal[k] = NULL;
  for (k = 0; k < 9; ++k) value->direction[k] = NULL;
}

/* Largest values [Pa] and their x, y, z [m], interpolated between nodes and depths. NaN: not wanted. */
typedef struct brn_stress_maxima {
  size_t struct_size;
  int32_t wants_von_mises; /* 0 or 1: what is looked for; default: the von Mises stress alone */
  int32_t wants_tresca;
  int32_t wants_principal_1;
  int32_t reserved;
  double von_mises, von_mises_at[3];
  double tresca, tresca_at[3];
  double principal_1, principal_1_at[3];
} brn_stress_maxima;

static inline void brn_stress_maxima_init(brn_stress_maxima *value) {
  int k;
  value->struct_size = sizeof *value;
  value->wants_von_mises = 1;
  value->wants_tresca = 0;
  value->wants_principal_1 = 0;
  value->reserved = 0;
  value->von_mises = 0.0;
  value->tresca = 0.0;
  value->principal_1 = 0.0;
  for (k = 0; k < 3; ++k) {
    value->von_mises_at[k] = 0.0;
    value->tresca_at[k] = 0.0;
    value->principal_1_at[k] = 0.0;
  }
}

/* Computes what fields have room for and what maxima want; either may be NULL. maxima alone stores no field.
 * BRN_TOO_LARGE: the engine's memory_limit does not allow the work, the caller's fields not counted. */
BRN_API brn_status brn_stress_compute(brn_engine *engine, const brn_stress_request *request,
                                      const brn_stress_fields *fields, brn_stress_maxima *maxima);

/* ---------------------------------------------------------------- plasticity */

/* Isotropic hardening: the yield stress [Pa] over the equivalent plastic strain p. It may not fall. */
enum {
  BRN_HARDENING_NONE = 0,           /* stays elastic */
  BRN_HARDENING_SWIFT = 1,          /* B (C + strain_scale*p)^n */
  BRN_HARDENING_LINEAR = 2,         /* yield_stress + hardening_modulus*p */
  BRN_HARDENING_PERFECT = 3,        /* yield_stress */
  BRN_HARDENING_VOCE = 4,           /* saturation_stress - (saturation_stress - yield_stress) exp(-rate*p) */
  BRN_HARDENING_RAMBERG_OSGOOD = 5, /* p = (stress/K)^m; with a yield_stress the larger of both */
  BRN_HARDENING_TABLE = 6 /* monotone piecewise cubic through the points (Fritsch & Carlson, 1980), then constant */
};

/* Each law reads its own members. Arrays are read during the call. */
typedef struct brn_hardening {
  size_t struct_size;
  int32_t law; /* BRN_HARDENING_... */
  int32_t reserved;
  double B;                     /* [Pa] > 0 */
  double C;                     /* >= 0 */
  double n;                     /* 0 to 1 */
  double strain_scale;          /* > 0; default 1e6 */
  double yield_stress;          /* [Pa] > 0; Ramberg-Osgood: 0 is flow from zero */
  double hardening_modulus;     /* [Pa] d stress/dp, >= 0 */
  double saturation_stress;     /* [Pa] >= yield_stress */
  double rate;                  /* > 0 */
  double K;                     /* [Pa] > 0 */
  double m;                     /* >= 1 */
  const double *plastic_strain; /* table: point_count values, rising from 0, */
  const double *stress;         /* and [Pa] > 0, never falling */
  size_t point_count;
  const double *depths;        /* any law: depth_count values [m], >= 0 and rising, */
  const double *depth_factors; /* and the factors on the yield stress there, > 0; linear between, constant beyond */
  size_t depth_count;          /* 0: the factor is 1 everywhere */
} brn_hardening;

static inline void brn_hardening_init(brn_hardening *value) {
  value->struct_size = sizeof *value;
  value->law = 0;
  value->reserved = 0;
  value->B = 0.0;
  value->C = 0.0;
  value->n = 0.0;
  value->strain_scale = 1e6;
  value->yield_stress = 0.0;
  value->hardening_modulus = 0.0;
  value->saturation_stress = 0.0;
  value->rate = 0.0;
  value->K = 0.0;
  value->m = 0.0;
  value->plastic_strain = NULL;
  value->stress = NULL;
  value->point_count = 0;
  value->depths = NULL;
  value->depth_factors = NULL;
  value->depth_count = 0;
}

/* The body hardens after this law (NULL or BRN_HARDENING_NONE: it stays elastic), whatever brn_scene_set_body makes
 * of it. Such scenes need a free boundary and layers; depths of brn_subsurface must be the
 * layers'. A run then solves plastic strain, residual stress and contact together; BRN_INVALID_SCENE from
 * brn_run_advance: plastic strain has reached the last layer or the grid's side, and the state is that before the
 * increment. */
BRN_API brn_status brn_scene_set_hardening(brn_scene *scene, int32_t which, const brn_hardening *hardening);

/* Layers of cuboids, thickness [m] > 0, in which plastic strain is uniform; their sides are the grid's spacing. */
BRN_API brn_status brn_scene_set_layers(brn_scene *scene, int64_t layers, double thickness);

/* 1: the upper body is the mirror image of the lower one, its material and hardening, and one field serves both.
 * Where they harden, neither may move or slide against the other (brn_step.offset, traction_ratio). */
BRN_API brn_status brn_scene_set_identical(brn_scene *scene, int32_t identical);

/* Points of one isotropic body, count doubles in each array. Trial stress: the stress if the strain increment were
 * elastic, tension positive, BRN_XX ... BRN_XY. */
typedef struct brn_return_points {
  size_t struct_size;
  size_t count;
  double shear_modulus;         /* [Pa] > 0 */
  const double *trial[6];       /* [Pa] */
  const double *plastic_strain; /* equivalent, before; >= 0 */
  const double *layer_depths;   /* [m] layer_count values: points lie layer after layer, equally many in each; */
  size_t layer_count;           /* needed if the hardening has depth factors, not read if it has none */
} brn_return_points;

static inline void brn_return_points_init(brn_return_points *value) {
  int k;
  value->struct_size = sizeof *value;
  value->count = 0;
  value->shear_modulus = 0.0;
  for (k = 0; k < 6; ++k) value->trial[k] = NULL;
  value->plastic_strain = NULL;
  value->layer_depths = NULL;
  value->layer_count = 0;
}

/* Where results go. increment and plastic_strain are needed, the others may be NULL. plastic_strain and stress may be
 * arrays of the points, which they then replace; increment may overlap none.
 *
 * The consistent tangent, with strain the total strain of the step, P the deviatoric part, N the unit direction of
 * the trial's deviator, which is that of the increment, and K the bulk modulus:
 *   d stress = K trace(d strain) 1 + 2 mu (theta P - theta_bar N N) : d strain
 * theta is the von Mises stress after over that of the trial, theta_bar 3 mu/(3 mu + slope) - (1 - theta) with the
 * slope of the hardening curve; 1 and 0 where the point stays elastic. */
typedef struct brn_return_result {
  size_t struct_size;
  size_t capacity;        /* doubles in each array that is not NULL */
  double *increment[6];   /* of plastic strain: tensor components BRN_XX ... BRN_XY, not engineering shears */
  double *plastic_strain; /* equivalent, after */
  double *von_mises;      /* after [Pa] */
  double *stress[6];      /* after [Pa]; all six or none */
  double *theta;
  double *theta_bar;
} brn_return_result;

static inline void brn_return_result_init(brn_return_result *value) {
  int k;
  value->struct_size = sizeof *value;
  value->capacity = 0;
  for (k = 0; k < 6; ++k) value->increment[k] = NULL;
  value->plastic_strain = NULL;
  value->von_mises = NULL;
  for (k = 0; k < 6; ++k) value->stress[k] = NULL;
  value->theta = NULL;
  value->theta_bar = NULL;
}

/* Radial return of rate-independent von Mises plasticity (Wilkins, 1964; Simo & Taylor, 1985), each point by itself:
 * where the von Mises stress of the trial is above the yield stress, plastic strain along its deviator takes it
 * there, stress = trial - 2 mu increment. The yield condition then holds to 1e-12 of the yield stress, whatever the
 * law's slope, and plastic strain never decreases. *plastic_count, unless NULL, receives how many points yielded. On
 * the engine's threads; calls from several threads are allowed. A value that is not finite or out of range (the
 * message names its point; von Mises stresses must be below 1e150 Pa) is BRN_INVALID_ARGUMENT, and results then
 * incomplete. */
BRN_API brn_status brn_return_map_batch(brn_engine *engine, const brn_hardening *hardening,
                                        const brn_return_points *points, const brn_return_result *result,
                                        int64_t *plastic_count);

#ifdef __cplusplus
}
#endif

#endif /* BRINELL_H */
