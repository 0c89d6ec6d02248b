/* What trajectories side by side need in every mode: sines for their inputs, accelerations, lengths of
 * steps, the first falls of guards, and ends of steps. The formulas are those of src/input,
 * src/integrate and src/hybrid/roots, which have the reasons; src/kernel/mod.rs calls the functions.
 *
 * Arrays of series have one row an order, `stride` numbers a row. A point of the motion is, one after
 * the other, the coordinates, velocities and accelerations, what rounding has lost of coordinates and of
 * velocities, and the time as a sum of two doubles.
 */
#include "lanes.h"
#ifdef __x86_64__
#include <immintrin.h>
#endif

/* The bits of a number, and numbers that are not negative. */
typedef long long word __attribute__((vector_size(8 * DALEMBERT_LANES), aligned(16)));
typedef unsigned long long counts __attribute__((vector_size(8 * DALEMBERT_LANES), aligned(16)));

/* Yes or no for each lane, in registers: a bit a lane where the processor compares so, else all bits of a
 * lane or none. Between functions it is a bit a lane.
 */
#if DALEMBERT_LANES == 8
typedef __mmask8 truth;
DALEMBERT_INLINE truth truth_of(unsigned bits) { return (truth)bits; }
DALEMBERT_INLINE unsigned bits(truth x) { return x; }
DALEMBERT_INLINE real pick(truth where, real yes, real no) {
  return (real)_mm512_mask_blend_pd(where, (__m512d)no, (__m512d)yes);
}
DALEMBERT_INLINE truth below(real x, real y) { return _mm512_cmp_pd_mask((__m512d)x, (__m512d)y, _CMP_LT_OQ); }
DALEMBERT_INLINE truth at_most(real x, real y) { return _mm512_cmp_pd_mask((__m512d)x, (__m512d)y, _CMP_LE_OQ); }
DALEMBERT_INLINE truth same(real x, real y) { return _mm512_cmp_pd_mask((__m512d)x, (__m512d)y, _CMP_EQ_OQ); }
DALEMBERT_INLINE truth is_negative(word x) { return _mm512_movepi64_mask((__m512i)x); }
#else
typedef word truth;
DALEMBERT_INLINE truth truth_of(unsigned bits) {
  word own;
  for (int i = 0; i < DALEMBERT_LANES; ++i) own[i] = 1LL << i;
  return (own & (long long)bits) != 0;
}
DALEMBERT_INLINE unsigned bits(truth x) {
  /* A level may be compiled for a processor that has more. */
#if DALEMBERT_LANES == 4
  return (unsigned)_mm256_movemask_pd((__m256d)x);
#elif defined(__x86_64__)
  return (unsigned)_mm_movemask_pd((__m128d)x);
#else
  unsigned all = 0;
  for (int i = 0; i < DALEMBERT_LANES; ++i) all |= (unsigned)(x[i] != 0) << i;
  return all;
#endif
}
DALEMBERT_INLINE real pick(truth where, real yes, real no) {
  return (real)(((truth)yes & where) | ((truth)no & ~where));
}
DALEMBERT_INLINE truth below(real x, real y) { return x < y; }
DALEMBERT_INLINE truth at_most(real x, real y) { return x <= y; }
DALEMBERT_INLINE truth same(real x, real y) { return x == y; }
DALEMBERT_INLINE truth is_negative(word x) { return x < 0; }
#endif
DALEMBERT_INLINE int any(truth x) { return bits(x) != 0; }

DALEMBERT_INLINE real size_of(real x) { return (real)((word)x & 0x7fffffffffffffff); }
/* The second one where they are equal or not to be compared, as the instructions have it. */
#if DALEMBERT_LANES == 8
DALEMBERT_INLINE real greater(real x, real y) { return (real)_mm512_max_pd((__m512d)x, (__m512d)y); }
DALEMBERT_INLINE real smaller(real x, real y) { return (real)_mm512_min_pd((__m512d)x, (__m512d)y); }
#elif DALEMBERT_LANES == 4
DALEMBERT_INLINE real greater(real x, real y) { return (real)_mm256_max_pd((__m256d)x, (__m256d)y); }
DALEMBERT_INLINE real smaller(real x, real y) { return (real)_mm256_min_pd((__m256d)x, (__m256d)y); }
#elif defined(__x86_64__)
DALEMBERT_INLINE real greater(real x, real y) { return (real)_mm_max_pd((__m128d)x, (__m128d)y); }
DALEMBERT_INLINE real smaller(real x, real y) { return (real)_mm_min_pd((__m128d)x, (__m128d)y); }
#else
DALEMBERT_INLINE real greater(real x, real y) { return pick(below(y, x), x, y); }
DALEMBERT_INLINE real smaller(real x, real y) { return pick(below(x, y), x, y); }
#endif

/* a + b = sum + what is returned, exactly (Knuth). */
DALEMBERT_INLINE real two_sum_of(real a, real b, real *sum) {
  const real s = a + b, from_a = s - b, from_b = s - from_a;
  *sum = s;
  return (a - from_a) + (b - from_b);
}

/* Numbers of free coordinates that are told apart: up to MOST_IN_LANES in codegen/analysis.py. */
#define FREE(with) with(0) with(1) with(2) with(3) with(4) with(5) with(6)

void LANES(dalembert_lane_sin_cos)(const real *x, real *sine, real *cosine);
void LANES(dalembert_lane_sin_cos)(const real *x, real *sine, real *cosine) {
  const struct dalembert_sin_cos pair = dalembert_sin_cos(*x);
  *sine = pair.sin;
  *cosine = pair.cos;
}

/* A sine for each lane, as LaneSines in src/input/sine.rs lays them out. */
struct sine { real amplitude, angular_frequency, start, end, sin_phase, cos_phase, of_integral, of_double_integral; };

/* y - sin y for y >= 0, as there. */
DALEMBERT_INLINE real less_its_sine(real y, real sin_y) {
  const truth near = below(y, REAL(1.0));
  const real far = y - sin_y;
  if (!any(near)) return far;
  const real y2 = y * y;
  real tail = REAL(1.0);
  for (int n = 9; n >= 2; --n) tail = 1.0 - y2 / (2.0 * n * (2.0 * n + 1.0)) * tail;
  return pick(near, y * y2 / 6.0 * tail, far);
}

/* Rate, value, integral and double integral of a sine just after the times t. */
void LANES(dalembert_lane_sine)(const struct sine *sine, const real *t, real *jet);
void LANES(dalembert_lane_sine)(const struct sine *sine, const real *t, real *jet) {
  const real amplitude = sine->amplitude, omega = sine->angular_frequency;
  const real start = sine->start, end = sine->end;
  const real acting = pick(below(*t, start), start, smaller(end, *t));
  const real y = omega * (acting - start);
  const struct dalembert_sin_cos half = dalembert_sin_cos(0.5 * y);
  const real sin_shifted = half.sin * sine->cos_phase + half.cos * sine->sin_phase;
  const real cos_shifted = half.cos * sine->cos_phase - half.sin * sine->sin_phase;
  const real integral = sine->of_integral * 2.0 * sin_shifted * half.sin;
  const real double_integral = sine->of_double_integral * (sine->cos_phase * less_its_sine(y, 2.0 * half.sin * half.cos)
                                                           + 2.0 * sine->sin_phase * half.sin * half.sin);
  const truth acts = at_most(start, *t) & below(*t, end);
  const real zero = REAL(0.0);
  jet[0] = pick(acts, amplitude * omega * (cos_shifted * half.cos - sin_shifted * half.sin), zero);
  jet[1] = pick(acts, amplitude * (sin_shifted * half.cos + cos_shifted * half.sin), zero);
  jet[2] = integral;
  jet[3] = double_integral + integral * pick(below(end, *t), *t - end, zero);
}

/* Rows of the Taylor coefficients of a sine, from its value and rate: each is *factor * inverses[k] times the
 * last but one.
 */
void LANES(dalembert_lane_sine_series)(size_t count, size_t stride, const real *factor, const double *inverses,
                                       const real *jet, real *row);
void LANES(dalembert_lane_sine_series)(size_t count, size_t stride, const real *factor, const double *inverses,
                                       const real *jet, real *row) {
  real now = jet[1], next = jet[0];
  for (size_t k = 0; k < count; ++k) {
    row[k * stride] = now;
    const real after = now * (*factor * inverses[k]);
    now = next;
    next = after;
  }
}

/* Rows of the Taylor coefficients of an antiderivative, from its value and those of its derivative, which are
 * in the entries before. inverses: of k.
 */
void LANES(dalembert_lane_antiderivative)(size_t count, size_t stride, const double *inverses, const real *value,
                                          real *row);
void LANES(dalembert_lane_antiderivative)(size_t count, size_t stride, const double *inverses, const real *value,
                                          real *row) {
  row[0] = *value;
  for (size_t k = 1; k < count; ++k) row[k * stride] = row[(k - 1) * stride - 1] * inverses[k];
}

/* Coordinates and velocities at the start of a step: the first rows of their series. */
void LANES(dalembert_lane_start)(size_t free, const real *point, real *q, real *v);
void LANES(dalembert_lane_start)(size_t free, const real *point, real *q, real *v) {
  for (size_t i = 0; i < free; ++i) {
    q[i] = point[i];
    v[i] = point[free + i];
  }
}

/* Inverse of a mass matrix by elimination without exchanges, and the accelerations, which are given where a
 * segment starts; with them the first rows of the series. system: the matrix by columns, then the load.
 * Gives the lanes in which not all pivots are positive. A pivot within the rounding of its own sum is not
 * told from zero.
 */
DALEMBERT_INLINE unsigned begin(const size_t free, const real *point, unsigned at_start, const real *system,
                                real *inverse, real *q, real *v, real *a) {
  const double rounding = ((double)free + 1.0) * 0x1p-52;
  real m[6 * 6];
  truth unclear = truth_of(0);
  for (size_t k = 0; k < free * free; ++k) {
    m[k] = system[k];
    inverse[k] = REAL(k % (free + 1) == 0 ? 1.0 : 0.0);
  }
  /* Columns: m[free j + i] is the entry of row i. */
  for (size_t k = 0; k < free; ++k) {
    const real pivot = m[free * k + k];
    unclear |= ~below(rounding * size_of(system[free * k + k]), pivot);
    for (size_t j = 0; j < free; ++j) {
      if (j > k) m[free * j + k] /= pivot;
      inverse[free * j + k] /= pivot;
    }
    for (size_t i = 0; i < free; ++i) {
      if (i == k) continue;
      const real factor = m[free * k + i];
      for (size_t j = 0; j < free; ++j) {
        if (j > k) m[free * j + i] -= factor * m[free * j + k];
        inverse[free * j + i] -= factor * inverse[free * j + k];
      }
    }
  }
  const truth given = truth_of(at_start);
  for (size_t i = 0; i < free; ++i) {
    real acceleration = REAL(0.0);
    for (size_t j = 0; j < free; ++j) acceleration -= inverse[free * j + i] * system[free * free + j];
    acceleration = pick(given, point[2 * free + i], acceleration);
    a[i] = acceleration;
    v[free + i] = acceleration;
    q[free + i] = v[i];
    q[2 * free + i] = 0.5 * acceleration;
  }
  return bits(unclear);
}

unsigned LANES(dalembert_lane_begin)(size_t free, const real *point, unsigned at_start, const real *system,
                                     real *inverse, real *q, real *v, real *a);
unsigned LANES(dalembert_lane_begin)(size_t free, const real *point, unsigned at_start, const real *system,
                                     real *inverse, real *q, real *v, real *a) {
  switch (free) {
#define CASE(n) case n: return begin(n, point, at_start, system, inverse, q, v, a);
    FREE(CASE)
#undef CASE
  }
  return 0;
}

/* The lanes in which not all numbers are positive. */
unsigned LANES(dalembert_lane_unmet)(size_t count, const real *x);
unsigned LANES(dalembert_lane_unmet)(size_t count, const real *x) {
  truth met = truth_of(~0U);
  for (size_t i = 0; i < count; ++i) met &= below(REAL(0.0), x[i]);
  return bits((truth)~met);
}

/* Sums that keep a processor busy while each of them waits for its last operation, and fit into its registers. */
#if DALEMBERT_LANES == 8
enum { SIDE_BY_SIDE = 4 };
#else
enum { SIDE_BY_SIDE = 2 };
#endif

/* Sums of row k times tau to the power k, for k < count and some taus side by side: in powers of tau^4 for every
 * fourth. Rows that fill up the last four are zero.
 */
DALEMBERT_INLINE void sums(const int taus, size_t count, size_t stride, const real *row, const real *tau, real *out) {
  real tau2[SIDE_BY_SIDE], tau4[SIDE_BY_SIDE], parts[SIDE_BY_SIDE][4] = {{{0}}};
  for (int of = 0; of < taus; ++of) {
    tau2[of] = tau[of] * tau[of];
    tau4[of] = tau2[of] * tau2[of];
  }
  for (size_t k = (count + 3) / 4 * 4; k > 0; k -= 4)
#pragma GCC unroll 4
    for (size_t i = 0; i < 4; ++i) {
      const real own = row[(k - 4 + i) * stride];
#pragma GCC unroll 4
      for (int of = 0; of < taus; ++of) parts[of][i] = parts[of][i] * tau4[of] + own;
    }
  for (int of = 0; of < taus; ++of)
    out[of] = (parts[of][0] + parts[of][1] * tau[of]) + (parts[of][2] + parts[of][3] * tau[of]) * tau2[of];
}

/* The same for one tau. */
DALEMBERT_INLINE real sum(size_t count, size_t stride, const real *row, real tau) {
  real out;
  sums(1, count, stride, row, &tau, &out);
  return out;
}

/* Rows that enter ranges by more than their sizes: codegen/ranges.c. */
enum { FIRST = 8 };

/* Middle of a range that a polynomial of `count` rows does not leave in a time, given its powers, and half its width.
 * Rows that fill up the last four are zero.
 */
DALEMBERT_INLINE real range(size_t count, size_t stride, const real *row, const real *powers, real *radius) {
  real least = REAL(0.0), most = REAL(0.0), others[4] = {{0}};
  for (size_t k = (count + 3) / 4 * 4; k > FIRST; k -= 4)
#pragma GCC unroll 4
    for (size_t i = 0; i < 4; ++i) others[i] = others[i] * powers[4] + size_of(row[(k - 4 + i) * stride]);
#pragma GCC unroll 8
  for (size_t k = FIRST; k-- > 0;) {
    const real own = k > 0 ? row[k * stride] * powers[k] : row[0];
    least = own + smaller(least, REAL(0.0));
    most = own + greater(most, REAL(0.0));
  }
  const real rest = (others[0] + others[1] * powers[1]) + (others[2] + others[3] * powers[1]) * powers[2];
  *radius = 0.5 * (most - least) + rest * (powers[4] * powers[4]);
  return 0.5 * (least + most);
}

DALEMBERT_INLINE void ranges(const size_t free, size_t count, const real *q, const real *v, const real *a, real tau,
                             real *middles, real *radii) {
  const real tau2 = tau * tau, tau4 = tau2 * tau2;
  const real powers[FIRST] = {REAL(1.0), tau, tau2, tau2 * tau, tau4, tau4 * tau, tau4 * tau2, tau4 * (tau2 * tau)};
  for (size_t i = 0; i < free; ++i) {
    const real middle = range(count, free, q + i, powers, radii + i);
    radii[i] += size_of(middle - q[i]);
    middles[i] = q[i];
    middles[free + i] = range(count, free, v + i, powers, radii + free + i);
    middles[2 * free + i] = range(count, free, a + i, powers, radii + 2 * free + i);
  }
}

void LANES(dalembert_lane_ranges)(size_t free, size_t count, const real *q, const real *v, const real *a,
                                  const real *tau, real *middles, real *radii);
void LANES(dalembert_lane_ranges)(size_t free, size_t count, const real *q, const real *v, const real *a,
                                  const real *tau, real *middles, real *radii) {
  switch (free) {
#define CASE(n) case n: ranges(n, count, q, v, a, *tau, middles, radii); break;
    FREE(CASE)
#undef CASE
  }
}

/* By how much the signal whose coefficients are given changes at most in the times tau. */
void LANES(dalembert_lane_signal_radius)(size_t count, size_t stride, const real *row, const real *tau, real *out);
void LANES(dalembert_lane_signal_radius)(size_t count, size_t stride, const real *row, const real *tau, real *out) {
  real change = REAL(0.0);
  for (size_t k = count - 1; k > 0; --k) change = (change + size_of(row[k * stride])) * *tau;
  *out = change;
}

/* Of a number >= 0, the binary logarithm in units of 2^-16, with a bias, and of numbers x of that, the whole part of x/n
 * given 1/n and 1/2 - 1/(2n), which leaves no quotient halfway between two whole numbers; and 2^x to a percent:
 * src/integrate/logarithm.rs.
 */
DALEMBERT_INLINE real places(real x) {
  return (real)((word)((counts)x >> 36) | (word)REAL(0x1p52)) - 0x1p52;
}
DALEMBERT_INLINE real part(real x, double inverse, double half) {
  return x * inverse - half + 0x1p52 - 0x1p52;
}
DALEMBERT_INLINE real power_of_two(real x) {
  const word biased = (word)(x + (0x1p52 + 0x3ff0000)) & 0xfffffffffffff;
  const real power = (real)(biased >> 16 << 52);
  const real fraction = (real)((biased & 0xffff) << 36 | (word)REAL(1.0)) - 1.0;
  return power * (1.0 + fraction * (1.0 - 0.343 * (1.0 - fraction)));
}

/* Length at which the last terms of a series of order p equal the tolerance, as it fits into what remains
 * up to the times `last` and is not more than the horizon. tolerances: the relative one, then absolute ones of the
 * coordinates, then of the velocities. terms: 1/n and 1/2 - 1/(2n) of the terms that limit it, of powers
 * n = p - 1, p, p + 1, p - 3 and p - 2, and what is added to their logarithms ÷ n: src/integrate/taylor/length.rs.
 * Gives the lanes in which it reaches `last`. Unclear are those whose series is not finite or whose time would not
 * advance.
 */
DALEMBERT_INLINE unsigned length(const size_t free, const size_t p, const real *q, const real *v, const real *a,
                             const real *tolerances, const double *terms, const real *point, const real *last,
                             const real *horizon, real *h, unsigned *unclear) {
  const real now = point[5 * free], rest = point[5 * free + 1];
  real remaining;
  const real error = two_sum_of(*last, -now, &remaining);
  remaining += error - rest;
  real sizes[5] = {{0}};
  truth finite = truth_of(~0U);
  for (size_t i = 0; i < free; ++i) {
    const real of_q = 1.0 / (tolerances[1 + i] + tolerances[0] * size_of(q[i]));
    const real of_v = 1.0 / (tolerances[1 + free + i] + tolerances[0] * size_of(v[i]));
    sizes[0] = greater(size_of(v[(p - 1) * free + i]) * of_v, sizes[0]);
    sizes[1] = greater(size_of(v[p * free + i]) * of_v, sizes[1]);
    sizes[1] = greater(size_of(q[p * free + i]) * of_q, sizes[1]);
    sizes[2] = greater(size_of(q[(p + 1) * free + i]) * of_q, sizes[2]);
    sizes[3] = greater(size_of(v[(p - 3) * free + i]) * of_v, sizes[3]);
    sizes[4] = greater(size_of(v[(p - 2) * free + i]) * of_v, sizes[4]);
    finite &= below(size_of(a[(p - 1) * free + i]), REAL(INFINITY));
  }
  real shortest = REAL(-INFINITY);
#pragma GCC unroll 5
  for (int k = 0; k < 5; ++k) {
    const real logarithm = part(places(sizes[k]), terms[k], terms[5 + k]) + terms[10 + k];
    shortest = greater(pick(at_most(REAL(0x1p-1022), sizes[k]), logarithm, REAL(-INFINITY)), shortest);
  }
  const real own = pick(below(REAL(-INFINITY), shortest), power_of_two(-shortest), REAL(INFINITY));
  const real longest = smaller(own, *horizon);
  const real half = pick(below(remaining, 2.0 * longest), 0.5 * remaining, longest);
  *h = pick(at_most(remaining, longest), remaining, half);
  *unclear |= bits((truth)~finite | same(now + *h, now));
  return bits(same(*h, remaining));
}

unsigned LANES(dalembert_lane_length)(size_t free, size_t p, const real *q, const real *v, const real *a,
                                  const real *tolerances, const double *terms, const real *point, const real *last,
                                  const real *horizon, real *h, unsigned *unclear);
unsigned LANES(dalembert_lane_length)(size_t free, size_t p, const real *q, const real *v, const real *a,
                                  const real *tolerances, const double *terms, const real *point, const real *last,
                                  const real *horizon, real *h, unsigned *unclear) {
  switch (free) {
#define CASE(n) \
  case n: return length(n, p, q, v, a, tolerances, terms, point, last, horizon, h, unclear);
    FREE(CASE)
#undef CASE
  }
  return 0;
}

/* The point after tau. */
DALEMBERT_INLINE void end(const size_t free, const size_t p, const real *q, const real *v, const real *a,
                          const real *point, const real *tau, real *to) {
  const real s = *tau;
  for (size_t i = 0; i < free; ++i) {
    const real change_of_q = sum(p + 1, free, q + free + i, s) * s + point[3 * free + i];
    const real change_of_v = sum(p, free, v + free + i, s) * s + point[4 * free + i];
    to[3 * free + i] = two_sum_of(point[i], change_of_q, &to[i]);
    to[4 * free + i] = two_sum_of(point[free + i], change_of_v, &to[free + i]);
    to[2 * free + i] = sum(p, free, a + i, s);
  }
  real now;
  const real error = two_sum_of(point[5 * free], s, &now);
  to[5 * free + 1] = two_sum_of(now, error + point[5 * free + 1], &to[5 * free]);
}

void LANES(dalembert_lane_end)(size_t free, size_t p, const real *q, const real *v, const real *a, const real *point,
                               const real *tau, real *to);
void LANES(dalembert_lane_end)(size_t free, size_t p, const real *q, const real *v, const real *a, const real *point,
                               const real *tau, real *to) {
  switch (free) {
#define CASE(n) case n: end(n, p, q, v, a, point, tau, to); return;
    FREE(CASE)
#undef CASE
  }
}

/* A guard that is linear: src/kernel/lanes.rs. */
struct guard {
  real factor, offset;
  /* Lanes in which it is zero at the start of the step: there the factor tau is divided out. */
  unsigned starts_at_zero;
};

/* The lanes in which an event before the time `last` certainly ends neither a standstill nor an accumulation that
 * is as short as its rounding, and those in which it may end another accumulation:
 * src/hybrid/accumulation/, which has the reasons. index: of the free coordinates among all. tolerances: as
 * for `length`. point: before the event, reset: all coordinates, velocities and discrete states after it,
 * after: the free ones, the time and the discrete states after the event before; where these are not numbers
 * there was none. hardly, shortest: parts of themselves that what stands still moves by at most, and part of
 * the time that a pattern takes at least. rests: whether an accumulation is looked for.
 */
unsigned LANES(dalembert_lane_is_apart)(size_t free, size_t coordinates, size_t discretes, const size_t *index,
                                        unsigned rests, double hardly, double shortest, const real *tolerances,
                                        const real *point, const real *reset, const real *after, const real *last,
                                        unsigned *may_rest);
unsigned LANES(dalembert_lane_is_apart)(size_t free, size_t coordinates, size_t discretes, const size_t *index,
                                        unsigned rests, double hardly, double shortest, const real *tolerances,
                                        const real *point, const real *reset, const real *after, const real *last,
                                        unsigned *may_rest) {
  const real now = point[5 * free];
  truth still = truth_of(~0U), near = still, alike = still;
  for (size_t i = 0; i < 2 * free; ++i) {
    const real own = reset[i < free ? index[i] : coordinates + index[i - free]];
    still &= at_most(size_of(point[i] - after[i]), hardly * size_of(after[i]));
    near &= at_most(size_of(own - after[i]), tolerances[1 + i] + tolerances[0] * size_of(own));
  }
  /* What repeats leads to the same discrete states, by their bits: never to ones that differ as numbers. */
  for (size_t i = 0; i < discretes; ++i) {
    const real own = reset[2 * coordinates + i], other = after[2 * free + 1 + i];
    alike &= (truth)~(below(own, other) | below(other, own));
  }
  const truth at_once = at_most(now - after[2 * free], shortest * now);
  const truth first = (truth)~same(after[2 * free], after[2 * free]);
  *may_rest = rests ? bits((truth)((near | alike) & ~first)) : 0;
  return bits((truth)(below(now, *last) & ~(still | at_once)));
}

/* Makes a guard factor * (discrete state) with the offset that it has one at the start of a step, where it is
 * factor * x + offset; discrete: null if none is a factor. Gives the lanes in which it is positive, or zero and
 * rises with the rate of x; rate: null if x is one.
 */
unsigned LANES(dalembert_lane_departs)(const real *x, const real *rate, double factor, const real *discrete,
                                       struct guard *guard);
unsigned LANES(dalembert_lane_departs)(const real *x, const real *rate, double factor, const real *discrete,
                                       struct guard *guard) {
  guard->factor = discrete ? factor * *discrete : REAL(factor);
  const real value = guard->factor * *x + guard->offset, zero = REAL(0.0);
  const truth at_zero = same(value, zero);
  guard->starts_at_zero = bits(at_zero);
  return bits(below(zero, value) | (rate ? (truth)(at_zero & below(zero, guard->factor * *rate)) : truth_of(0)));
}

/* Goes on in some lanes from the state that a reset gives, and remembers it: names as in `is_apart`. */
void LANES(dalembert_lane_leap)(size_t free, size_t coordinates, size_t discretes, const size_t *index,
                                unsigned where, const real *reset, real *point, real *after);
void LANES(dalembert_lane_leap)(size_t free, size_t coordinates, size_t discretes, const size_t *index,
                                unsigned where, const real *reset, real *point, real *after) {
  const truth lanes = truth_of(where);
  for (size_t i = 0; i < 2 * free; ++i) {
    const real own = reset[i < free ? index[i] : coordinates + index[i - free]];
    point[i] = pick(lanes, own, point[i]);
    point[3 * free + i] = pick(lanes, REAL(0.0), point[3 * free + i]);
    after[i] = pick(lanes, own, after[i]);
  }
  after[2 * free] = pick(lanes, point[5 * free], after[2 * free]);
  for (size_t i = 0; i < discretes; ++i)
    after[2 * free + 1 + i] = pick(lanes, reset[2 * coordinates + i], after[2 * free + 1 + i]);
}

/* Extremes of each coordinate, then of each velocity: the least value, the greatest one, and when they were first
 * taken. Those of some lanes take note of a point.
 */
void LANES(dalembert_lane_note)(size_t free, unsigned where, const real *point, real *extremes);
void LANES(dalembert_lane_note)(size_t free, unsigned where, const real *point, real *extremes) {
  const truth lanes = truth_of(where);
  const real now = point[5 * free] + point[5 * free + 1];
  for (size_t i = 0; i < 2 * free; ++i) {
    real *own = extremes + 4 * i;
    const truth less = lanes & below(point[i], own[0]), more = lanes & below(own[1], point[i]);
    own[0] = pick(less, point[i], own[0]);
    own[2] = pick(less, now, own[2]);
    own[1] = pick(more, point[i], own[1]);
    own[3] = pick(more, now, own[3]);
  }
}

/* Bounds of what a series adds to its first term up to s, by its powers up to p: from above, from below, and of the
 * magnitude. */
struct spread { real above, below, size; };
DALEMBERT_INLINE struct spread spread(const size_t p, const size_t stride, const real *c, real s) {
  struct spread all = {{0}, {0}, {0}};
  for (size_t k = p; k > 0; --k) {
    const real own = c[k * stride], zero = REAL(0.0);
    all.above = (all.above + greater(own, zero)) * s;
    all.below = (all.below + smaller(own, zero)) * s;
  }
  all.size = all.above - all.below;
  return all;
}

/* The lanes in which a coordinate or a velocity may be beyond its extremes within tau: where its derivative may change
 * its sign (elsewhere the ends are the extremes), and of coordinates that are bent one way on that side alone. Names as for
 * `end` and `note`.
 */
unsigned LANES(dalembert_lane_may_exceed)(size_t free, size_t p, const real *q, const real *v, const real *a,
                                          const real *tau, const real *extremes);
unsigned LANES(dalembert_lane_may_exceed)(size_t free, size_t p, const real *q, const real *v, const real *a,
                                          const real *tau, const real *extremes) {
  truth may = truth_of(0);
  const real zero = REAL(0.0);
  for (size_t i = 0; i < free; ++i) {
    const real *rows[3] = {q + i, v + i, a + i};
    struct spread spreads[3];
    for (size_t k = 0; k < 3; ++k) spreads[k] = spread(p + 1 - k, free, rows[k], *tau);
    const truth bent = below(spreads[2].size, size_of(a[i])), no = truth_of(0);
    const truth concave = bent & below(a[i], zero), convex = bent & below(zero, a[i]);
    for (size_t k = 0; k < 2; ++k) {
      const real value = *rows[k], *own = extremes + 4 * (k * free + i);
      const truth inside = (at_most(own[0], value + spreads[k].below) | (k ? no : concave)) &
                           (at_most(value + spreads[k].above, own[1]) | (k ? no : convex));
      const truth one_way = below(spreads[k + 1].size, size_of(*rows[k + 1]));
      may |= (truth)~(inside | one_way);
    }
  }
  return bits(may);
}

/* Takes over numbers in some lanes. */
void LANES(dalembert_lane_take)(size_t count, unsigned where, const real *from, real *to);
void LANES(dalembert_lane_take)(size_t count, unsigned where, const real *from, real *to) {
  for (size_t i = 0; i < count; ++i) to[i] = pick(truth_of(where), from[i], to[i]);
}

/* Durations of steps of length h up to the parts `places` of them, all of them where these are more than one;
 * the rounding of that; and the part `farthest` of h. */
void LANES(dalembert_lane_durations)(const real *h, const real *places, double farthest, real *durations);
void LANES(dalembert_lane_durations)(const real *h, const real *places, double farthest, real *durations) {
  const real tau = *h * smaller(*places, REAL(1.0)), least = REAL(0x1p-1022);
  durations[0] = pick(below(tau, least), least, tau);
  durations[1] = durations[0] * 0x1p-52;
  durations[2] = *h * farthest;
}

/* Numbers of coefficients that are told apart. */
#define DEGREES(with) with(4) with(8) with(12) with(16) with(20) with(24) with(28) with(32) with(36)

/* Steps to a root: the fourth order needs two from a tenth of the window away; more where it is nearly
 * tangent. LAST_STEP is a relative step after which the iteration has ended, since it leaves the fourth
 * power of its last step: the fourth root of the unit roundoff.
 */
enum { MOST_ITERATIONS = 8 };
static const double LAST_STEP = 1.0e-4;

/* A polynomial about s: its first Taylor coefficients there. */
struct local { real value, slope, second, third; };

/* The sum of c[k] s^k, k < n with even n, from its even and its odd part side by side. */
DALEMBERT_INLINE struct local local(const int n, const real *c, real s) {
  const real x = s * s;
  real value[2] = {c[n - 2], c[n - 1]}, slope[2] = {{0}}, second[2] = {{0}}, third[2] = {{0}};
#pragma GCC unroll 36
  for (int k = n - 4; k >= 0; k -= 2) {
    for (int odd = 0; odd < 2; ++odd) {
      third[odd] = third[odd] * x + second[odd];
      second[odd] = second[odd] * x + slope[odd];
      slope[odd] = slope[odd] * x + value[odd];
      value[odd] = value[odd] * x + c[k + odd];
    }
  }
  /* e(s^2) + s o(s^2), by the chain rule. */
  struct local at;
  at.value = value[0] + s * value[1];
  at.slope = 2.0 * s * (slope[0] + s * slope[1]) + value[1];
  at.second = 4.0 * x * (second[0] + s * second[1]) + (slope[0] + 3.0 * s * slope[1]);
  at.third = 8.0 * x * (second[1] + s * third[0] + x * third[1]) + (slope[1] + 4.0 * s * second[0]);
  return at;
}

/* The first fall on 0 < s <= 1 of the sum of c[k] s^k, k < n. Certain are lanes without a fall (place:
 * infinite) and those in which the Bernstein coefficients change their sign once (place: a root, to
 * rounding); of all others the place is not a number.
 */
DALEMBERT_INLINE real first_crossing(const int n, const real *c) {
  real sizes[2] = {size_of(c[0]), size_of(c[1])}, least[2] = {c[0], smaller(c[1], REAL(0.0))};
#pragma GCC unroll 36
  for (int k = 2; k < n; ++k) {
    sizes[k % 2] += size_of(c[k]);
    least[k % 2] += smaller(c[k], REAL(0.0));
  }
  /* Each Bernstein coefficient is a sum of n terms, none larger than its power's. */
  const real margin = (sizes[0] + sizes[1]) * (n * 0x1p-52);
  const real none = REAL(INFINITY);
  /* Where the negative terms cannot outweigh the first there is no fall. */
  if (!any((truth)~below(margin, least[0] + least[1]))) return none;
  real b[36];
  double binomial = 1.0; /* n - 1 over k */
#pragma GCC unroll 36
  for (int k = 0; k < n; ++k) {
    b[k] = c[k] * (1.0 / binomial);
    binomial = binomial * (n - 1 - k) / (k + 1);
  }
#pragma GCC unroll 36
  for (int first = 1; first < n; ++first) {
#pragma GCC unroll 36
    for (int k = n - 1; k >= first; --k) b[k] += b[k - 1];
  }
  /* Whether all are certainly positive up to some place and certainly negative from there on: the first is
   * positive, none is near zero, and none rises from a negative one to a positive one. No chain of comparisons
   * that wait for each other. Where one is not a number the margin is none either, and nothing is above it. */
  real least_size[2] = {size_of(b[0]), size_of(b[1])};
  word rises = {0};
  counts negative = {0};
#pragma GCC unroll 36
  for (int k = 1; k < n; ++k) {
    if (k > 1) least_size[k % 2] = smaller(size_of(b[k]), least_size[k % 2]);
    rises |= (word)b[k - 1] & ~(word)b[k];
    negative += (counts)b[k] >> 63;
  }
  const truth once = below(margin, b[0]) & below(margin, smaller(least_size[0], least_size[1]))
                     & (truth)~is_negative(rises);
  const real fallen = __builtin_convertvector((word)negative, real);
  const truth falls = once & below(REAL(0.0), fallen);
  real found = pick(once & (truth)~falls, none, REAL(NAN));
  if (!any(falls)) return found;
  /* In the middle between the last positive one and the first negative one. */
  real s = ((n - 0.5) - fallen) * (1.0 / (n - 1));
  truth moving = falls;
  for (int i = 0; i < MOST_ITERATIONS && any(moving); ++i) {
    const struct local at = local(n, c, s);
    /* Householder's step of fourth order (Householder 1970, section 4.4). */
    const real slope2 = at.slope * at.slope, product = at.value * at.second;
    const real step = -at.value * (slope2 - product)
                      / (at.slope * (slope2 - 2.0 * product) + at.value * at.value * at.third);
    const real next = s + step;
    const truth ended = at_most(size_of(step), LAST_STEP * next);
    s = pick(moving, next, s);
    moving &= ~ended;
  }
  /* A step that has left the window, or has not ended, leads to no root. */
  return pick(falls & ~moving & below(REAL(0.0), s) & at_most(s, REAL(1.0)), s, found);
}

/* The same of a guard up to h, of `count` rows; the others up to n are filled up with zeros. c gets the coefficients
 * in powers of tau/h.
 */
DALEMBERT_INLINE real first_crossing_of(const int n, size_t count, size_t stride, const real *row, real h,
                                        const struct guard *guard, real *c) {
  const truth rises = truth_of(guard->starts_at_zero);
  const real h2 = h * h;
  real powers[2] = {guard->factor, guard->factor * h}, own[37];
#pragma GCC unroll 36
  for (int k = 0; k < n; ++k) {
    own[k] = k < n - 3 || (size_t)k < count ? row[k * stride] * powers[k % 2] : REAL(0.0);
    if (k == 0) own[0] += guard->offset;
    c[k] = own[k];
    powers[k % 2] *= h2;
  }
  own[n] = REAL(0.0);
  /* What is zero at the start: its sum by tau/h. */
#pragma GCC unroll 36
  for (int k = 0; k < n; ++k) own[k] = pick(rises, own[k + 1], own[k]);
  return first_crossing(n, own);
}

/* Looks for the first fall of factor * (row k times tau^k) + offset on 0 < tau <= h. Where it is before
 * `place`, a part of h, that becomes it: gives these lanes. c gets the coefficients in powers of tau/h.
 * Unclear are lanes where that takes a closer look.
 */
unsigned LANES(dalembert_lane_first_crossing)(size_t count, size_t stride, const real *row, const real *h,
                                              const struct guard *guard, real *c, real *place, unsigned *unclear);
unsigned LANES(dalembert_lane_first_crossing)(size_t count, size_t stride, const real *row, const real *h,
                                              const struct guard *guard, real *c, real *place, unsigned *unclear) {
  real found = REAL(NAN);
  /* With their number known the compiler keeps all coefficients in registers. */
  switch ((count + 3) / 4 * 4) {
#define CASE(n) \
  case n: found = first_crossing_of(n, count, stride, row, *h, guard, c); break;
    DEGREES(CASE)
#undef CASE
  }
  const truth first = at_most(found, REAL(1.0)) & below(found, *place);
  *place = pick(first, found, *place);
  *unclear = bits((truth)~same(found, found));
  return bits(first);
}

/* Moves tau of some lanes on until the guard factor * (row k times tau^k) + offset is negative there: by `more`,
 * twice as much each time, but not beyond `most`. The next places are looked at before it is known whether they are
 * needed.
 */
void LANES(dalembert_lane_cross)(size_t count, size_t stride, const real *row, const real *lost,
                                 const struct guard *guard, unsigned where, const real *most, real *more, real *tau);
void LANES(dalembert_lane_cross)(size_t count, size_t stride, const real *row, const real *lost,
                                 const struct guard *guard, unsigned where, const real *most, real *more, real *tau) {
  const struct guard own = *guard;
  const real start = *row, left = *lost, farthest = *most;
  real taus[SIDE_BY_SIDE + 1], mores[SIDE_BY_SIDE + 1], changes[SIDE_BY_SIDE];
  truth moving = truth_of(where);
  taus[0] = *tau;
  mores[0] = *more;
  while (any(moving)) {
    for (int i = 0; i < SIDE_BY_SIDE; ++i) {
      taus[i + 1] = taus[i] + mores[i];
      mores[i + 1] = 2.0 * mores[i];
    }
    sums(SIDE_BY_SIDE, count - 1, stride, row + stride, taus, changes);
    for (int i = 0; i < SIDE_BY_SIDE; ++i) {
      const real x = start + (changes[i] * taus[i] + left);
      moving &= (truth)~below(own.factor * x + own.offset, REAL(0.0)) & at_most(mores[i], farthest);
      taus[0] = pick(moving, taus[i + 1], taus[0]);
      mores[0] = pick(moving, mores[i + 1], mores[0]);
    }
  }
  *tau = taus[0];
  *more = mores[0];
}

/* The lanes in which the value of a guard is negative after tau, which is not more than h. */
unsigned LANES(dalembert_lane_crossed)(const real *value, const real *tau, const real *h);
unsigned LANES(dalembert_lane_crossed)(const real *value, const real *tau, const real *h) {
  return bits((truth)(below(*value, REAL(0.0)) & at_most(*tau, *h)));
}
