/* What trajectories side by side need in every mode: sines for their inputs, lengths of steps, values of
 * series, and the first falls of guards. The formulas are those of src/input, src/integrate/taylor and
 * src/hybrid/roots, which have the reasons; src/kernel/mod.rs calls the functions.
 *
 * Arrays of series have one row an order, `stride` numbers a row.
 */
#include "lanes.h"

/* All bits of a lane for true, none for false: what a comparison gives. */
typedef long long truth __attribute__((vector_size(8 * DALEMBERT_LANES), aligned(16)));

DALEMBERT_INLINE real pick(truth where, real yes, real no) {
  return (real)(((truth)yes & where) | ((truth)no & ~where));
}
DALEMBERT_INLINE real size_of(real x) { return (real)((truth)x & 0x7fffffffffffffff); }
DALEMBERT_INLINE real greater(real x, real y) { return pick(x > y, x, y); }
DALEMBERT_INLINE real smaller(real x, real y) { return pick(x < y, x, y); }
DALEMBERT_INLINE int any(truth x) {
  long long all = 0;
  for (int i = 0; i < DALEMBERT_LANES; ++i) all |= x[i];
  return all != 0;
}

void LANES(dalembert_lane_sin_cos)(const real *x, real *sine, real *cosine);
void LANES(dalembert_lane_sin_cos)(const real *x, real *sine, real *cosine) {
  const struct dalembert_sin_cos pair = dalembert_sin_cos(*x);
  *sine = pair.sin;
  *cosine = pair.cos;
}

/* Sum of row k times tau to the power k, for k < count: in powers of tau^4 for every fourth. */
DALEMBERT_INLINE real sum(size_t count, size_t stride, const real *row, real tau) {
  const real tau2 = tau * tau, tau4 = tau2 * tau2;
  real sums[4] = {{0}};
  size_t k = count / 4 * 4;
  for (size_t i = 0; k + i < count; ++i) sums[i] = row[(k + i) * stride];
  while (k > 0) {
    k -= 4;
    for (size_t i = 0; i < 4; ++i) sums[i] = sums[i] * tau4 + row[(k + i) * stride];
  }
  return (sums[0] + sums[1] * tau) + (sums[2] + sums[3] * tau) * tau2;
}

void LANES(dalembert_lane_sum)(size_t count, size_t stride, const real *row, const real *tau, real *out);
void LANES(dalembert_lane_sum)(size_t count, size_t stride, const real *row, const real *tau, real *out) {
  *out = sum(count, stride, row, *tau);
}

/* 2^(-x) to a percent for 0 <= x <= 1: src/integrate/logarithm.rs. */
DALEMBERT_INLINE real inverse_power(real x) {
  const real fraction = 1.0 - x;
  return 0.5 * (1.0 + fraction * (1.0 - 0.343 * (1.0 - fraction)));
}

/* x^(-1/n) for positive normal x, and infinity for zero, as there. */
DALEMBERT_INLINE real inverse_root(real x, double n) {
  const truth bits = (truth)x;
  const real exponent = __builtin_convertvector(bits >> 52, real) - 1023.0;
  const real mantissa = (real)((bits & 0xfffffffffffff) | 0x3ff0000000000000) - 1.0;
  const real fraction = mantissa * (1.0 + 0.347 * (1.0 - mantissa));
  /* exponent = n whole + rest with 0 <= rest < n; the first guess is off by one at most. */
  real whole = __builtin_convertvector(__builtin_convertvector(exponent / n, truth), real);
  whole = pick(exponent - n * whole < 0.0, whole - 1.0, whole);
  const real rest = exponent - n * whole;
  const real power = (real)((1023 - __builtin_convertvector(whole, truth)) << 52);
  const real root = power * inverse_power((rest + fraction) / n);
  return pick(x >= 0x1p-1022, root, REAL(INFINITY));
}

/* Length at which the last terms of a series of order p equal the tolerance, as it fits into what
 * remains and is not more than the horizon. tolerances: relative, then absolute ones of the coordinates,
 * then of the velocities. The terms of order p - 3 and p - 2 limit it, too, times their factors:
 * src/integrate/taylor/length.rs.
 */
void LANES(dalembert_lane_length)(size_t free, size_t p, const real *q, const real *v, const double *tolerances,
                                  const double *factors, const real *remaining, const real *horizon, real *out);
void LANES(dalembert_lane_length)(size_t free, size_t p, const real *q, const real *v, const double *tolerances,
                                  const double *factors, const real *remaining, const real *horizon, real *out) {
  real sizes[3] = {{0}}, earlier[2] = {{0}};
  for (size_t i = 0; i < free; ++i) {
    const real of_q = 1.0 / (tolerances[1 + i] + tolerances[0] * size_of(q[i]));
    const real of_v = 1.0 / (tolerances[1 + free + i] + tolerances[0] * size_of(v[i]));
    sizes[0] = greater(size_of(v[(p - 1) * free + i]) * of_v, sizes[0]);
    sizes[1] = greater(size_of(v[p * free + i]) * of_v, sizes[1]);
    sizes[1] = greater(size_of(q[p * free + i]) * of_q, sizes[1]);
    sizes[2] = greater(size_of(q[(p + 1) * free + i]) * of_q, sizes[2]);
    for (size_t k = 0; k < 2; ++k) earlier[k] = greater(size_of(v[(p - 3 + k) * free + i]) * of_v, earlier[k]);
  }
  real length = *horizon;
  for (size_t k = 0; k < 3; ++k) length = smaller(inverse_root(sizes[k], (double)(p + k - 1)), length);
  for (size_t k = 0; k < 2; ++k) length = smaller(factors[k] * inverse_root(earlier[k], (double)(p - 3 + k)), length);
  const real half = pick(2.0 * length > *remaining, 0.5 * *remaining, length);
  *out = pick(length >= *remaining, *remaining, half);
}

/* Numbers of coefficients that are told apart. */
#define DEGREES(with) with(4) with(8) with(12) with(16) with(20) with(24) with(28) with(32)

/* Steps to a root: the third order needs three from half a window away; more where it is nearly
 * tangent. LAST_STEP is a relative step after which the iteration has ended, since it leaves the cube of
 * its last step: the cube root of the unit roundoff.
 */
enum { MOST_ITERATIONS = 8 };
static const double LAST_STEP = 4.8e-6;

/* The first fall on 0 < s <= 1 of the sum of c[k] s^k, k < n. Certain are lanes without a fall (place:
 * infinite) and those in which the Bernstein coefficients change their sign once (place: a root, to
 * rounding); of all others the place is not a number.
 */
DALEMBERT_INLINE real first_fall(const int n, const real *c) {
  real size = size_of(c[0]), least = c[0];
  for (int k = 1; k < n; ++k) {
    size += size_of(c[k]);
    least += smaller(c[k], REAL(0.0));
  }
  /* Each Bernstein coefficient is a sum of n terms, none larger than its power's. */
  const real margin = size * (n * 0x1p-52);
  const real none = REAL(INFINITY);
  /* Where the negative terms cannot outweigh the first there is no fall. */
  if (!any(~(least > margin))) return none;
  real b[32];
  double binomial = 1.0; /* n - 1 over k */
  for (int k = 0; k < n; ++k) {
    b[k] = c[k] * (1.0 / binomial);
    binomial = binomial * (n - 1 - k) / (k + 1);
  }
#pragma GCC unroll 32
  for (int first = 1; first < n; ++first) {
#pragma GCC unroll 32
    for (int k = n - 1; k >= first; --k) b[k] += b[k - 1];
  }
  /* Whether all are certainly positive up to some place and certainly negative from there on. */
  truth positive = b[0] > margin, once = positive;
  real place = REAL(0.0);
#pragma GCC unroll 32
  for (int k = 1; k < n; ++k) {
    const truth still = positive & (b[k] > margin), below = b[k] < -margin;
    once &= still | below;
    /* Where the polygon of the coefficients falls through zero. */
    const real fall = ((double)(k - 1) + b[k - 1] / (b[k - 1] - b[k])) * (1.0 / (n - 1));
    place = pick(positive & below, fall, place);
    positive = still;
  }
  const truth falls = once & ~positive;
  real found = pick(positive, none, REAL(NAN));
  if (!any(falls)) return found;
  real s = place;
  truth moving = falls;
  for (int i = 0; i < MOST_ITERATIONS && any(moving); ++i) {
    real value = c[n - 1], slope = REAL(0.0), half_curvature = REAL(0.0);
#pragma GCC unroll 32
    for (int k = n - 2; k >= 0; --k) {
      half_curvature = half_curvature * s + slope;
      slope = slope * s + value;
      value = value * s + c[k];
    }
    /* The root of the parabola at s that a falling piece leads to, or Newton's. */
    const real discriminant = slope * slope - 4.0 * half_curvature * value;
    const truth parabola = (discriminant > 0.0) & (slope < 0.0);
    const real root = sqrt(pick(parabola, discriminant, REAL(1.0)));
    const real step = pick(parabola, 2.0 * value, -value) / pick(parabola, root - slope, slope);
    const real next = s + step;
    const truth ended = size_of(step) <= LAST_STEP * next;
    s = pick(moving, next, s);
    moving &= ~ended;
  }
  /* A step that has left the window, or has not ended, leads to no root. */
  return pick(falls & ~moving & (s > 0.0) & (s <= 1.0), s, found);
}

/* The first fall of factor * (row k times tau^k) + offset on 0 < tau <= h, as a part of h. Of those that
 * start at zero the factor tau is divided out. c gets the coefficients in powers of tau/h.
 */
void LANES(dalembert_lane_first_fall)(size_t count, size_t stride, const real *row, const real *h, const real *factor,
                                      const real *offset, const truth *starts_at_zero, real *c, real *out);
void LANES(dalembert_lane_first_fall)(size_t count, size_t stride, const real *row, const real *h, const real *factor,
                                      const real *offset, const truth *starts_at_zero, real *c, real *out) {
  const size_t room = (count + 3) / 4 * 4;
  real power = *factor, rising[32];
  for (size_t k = 0; k < count; ++k) {
    c[k] = row[k * stride] * power;
    power *= *h;
  }
  for (size_t k = count; k < room; ++k) c[k] = REAL(0.0);
  c[0] += *offset;
  for (size_t k = 0; k < room; ++k) rising[k] = pick(*starts_at_zero, k + 1 < room ? c[k + 1] : REAL(0.0), c[k]);
  /* With their number known the compiler keeps all of them in registers. */
  switch (room) {
#define CASE(n) case n: *out = first_fall(n, rising); return;
    DEGREES(CASE)
  }
}
