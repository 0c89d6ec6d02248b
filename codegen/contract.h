/* The contract: what a compiled model and the engine share, and nothing else (src/kernel/ reads it).
 *
 * A model exports one constant, a `struct dalembert_model`. Its first fields, up to the digest, keep their places
 * in all versions, so that any engine can tell what it has before it. What is data is JSON: names, units,
 * meanings, modes, guards, and for each function its place in the tables below; codegen/description.py writes it,
 * src/model/description/ reads it and checks every index.
 *
 * A `real` is a double; in code for lanes, trajectories side by side, a vector of them (lanes.h).
 */
#ifndef DALEMBERT_CONTRACT_H
#define DALEMBERT_CONTRACT_H
#include <stddef.h>
#include <stdint.h>

/* Changes whenever something below or in the description does. */
#define DALEMBERT_CONTRACT_VERSION 14
#define DALEMBERT_CONTRACT_MARK {'d', 'a', 'l', 'e', 'm', 'b', 'r', 't'}

/* What a function needs besides the free coordinates of its mode. Angles: sines and cosines computed last. */
struct dalembert_context {
  const real *u;     /* signals of the inputs */
  const real *u_dot; /* their rates; where bounds are computed, radii of the signals */
  const real *d;     /* discrete states */
  const real *h;     /* coordinates, then prescribed motions: what the mode holds, where it does or began to */
  const real *c;     /* constants: what depends on parameters alone */
  const real *j;     /* jerks; where bounds are computed, radii of q, v and a */
  struct dalembert_angle *angles;
};

/* Outputs at a state, dense and column-major. */
typedef void dalembert_value(const real *q, const real *v, const real *a, const struct dalembert_context *x, real *out);

/* Taylor coefficients along a motion, of order 0 and of the orders 1 to n - 1: see emit_series.py. The arrays hold one
 * row an order; w is a workspace. */
typedef void dalembert_series_start(real *q, real *v, real *a, const real *u, const struct dalembert_context *x,
                                    real *w, real *out);
typedef void dalembert_series_run(size_t n, real *q, real *v, real *a, const real *u, const struct dalembert_context *x,
                                  real *w, real *out);

/* Tables of functions, which the description refers to by their places. Those for lanes are as long, and null where
 * there is no such function. */
struct dalembert_functions {
  size_t values;
  dalembert_value *const *value;
  size_t series;
  dalembert_series_start *const *start;
  dalembert_series_run *const *run;
};

/* For lanes: a table for each level of the processor that the code was compiled for, null where there is none. */
enum { DALEMBERT_LEVELS = 3 };

struct dalembert_model {
  char mark[8];      /* DALEMBERT_CONTRACT_MARK */
  uint32_t version;  /* DALEMBERT_CONTRACT_VERSION */
  uint32_t size;     /* of this structure, bytes */
  char digest[64];   /* of all that the code was made from, lower-case hexadecimal, filled up by zeros */
  const char *name;  /* ends with a zero */
  size_t description_length;
  const char *description; /* JSON */
  struct dalembert_functions functions;
  const struct dalembert_functions *lanes[DALEMBERT_LEVELS];
};
#endif
