/* Ranges that the polynomials of a step do not leave. Of the first terms it is that of Horner's scheme in interval
 * arithmetic (Moore 1966), which tells growth from oscillation: a sum of the terms from k on lies between the kth and
 * what it adds to sums below and above zero. The others are small, and enter by their sizes. What waits for the term
 * before is short so.
 */
#include "vectors.h"

/* Six are too few for half a period of an oscillation, about a step of the Taylor method where a series costs
 * something; over the period of a linear motion eight tell little. As in lanes.c.
 */
enum { FIRST = 8 };

void dalembert_ranges(size_t free, size_t count, const double *q, const double *v, const double *a, double tau,
                      double *middles, double *radii);

#if DALEMBERT_BLOCK == 4
/* The part of x that is on one side of zero; its size. */
typedef int64_t mask __attribute__((vector_size(32)));
#define PART(x, side) ((dalembert_block)((mask)(x) & (mask)((x) side 0.0)))
#define SIZE(x) ((dalembert_block)((mask)(x) & INT64_MAX))

#define FOUR(row) ((dalembert_block){(row)[0], (row)[free], (row)[2 * free], (row)[3 * free]})
#define SUM(x) ((x[0] + x[2]) + (x[1] + x[3]))

static inline __attribute__((always_inline)) void ranges(size_t free, size_t count, const double *q, const double *v,
                                                         const double *a, double tau, double *middles, double *radii) {
  /* In registers: a block read from numbers written one by one waits for all of them to reach memory. */
  const double tau2 = tau * tau, tau3 = tau2 * tau, tau4 = tau2 * tau2;
  const double powers[FIRST] = {1.0, tau, tau2, tau3, tau4, tau4 * tau, tau4 * tau2, tau4 * tau3};
  dalembert_block power = (dalembert_block){1.0, tau, tau2, tau3} * (tau4 * tau4);
  dalembert_block of_q = {0.0}, of_v = {0.0}, of_a = {0.0};
  for (size_t k = FIRST; k < count; k += 4) {
    of_q += SIZE(FOUR(q + k * free)) * power;
    of_v += SIZE(FOUR(v + k * free)) * power;
    of_a += SIZE(FOUR(a + k * free)) * power;
    power *= tau4;
  }
  dalembert_block least = {0.0}, most = {0.0};
  for (size_t k = FIRST; k-- > 0;) {
    const dalembert_block own = (dalembert_block){q[k * free], v[k * free], a[k * free], 0.0} * powers[k];
    least = own + PART(least, <);
    most = own + PART(most, >);
  }
  const dalembert_block others = {SUM(of_q), SUM(of_v), SUM(of_a), 0.0};
  const dalembert_block middle = 0.5 * (least + most);
  /* Not by an element of its own, which would be a way through memory. */
  const mask is_q = {-1};
  const dalembert_block start = {q[0]};
  const dalembert_block centre = (dalembert_block)(((mask)start & is_q) | ((mask)middle & ~is_q));
  const dalembert_block radius = 0.5 * (most - least) + SIZE(middle - centre) + others;
  for (size_t n = 0; n < 3; ++n) middles[n * free] = centre[n], radii[n * free] = radius[n];
}
#else
static void ranges(size_t free, size_t count, const double *q, const double *v, const double *a, double tau,
                   double *middles, double *radii) {
  const double *const rows[] = {q, v, a};
  for (size_t n = 0; n < 3; ++n) {
    double others = 0.0, power = 1.0, least = 0.0, most = 0.0, terms[FIRST];
    for (size_t k = 0; k < count; ++k, power *= tau) {
      const double own = rows[n][k * free] * power;
      if (k < FIRST) terms[k] = own;
      else others += own < 0.0 ? -own : own;
    }
    for (size_t k = FIRST; k-- > 0;) {
      least = terms[k] + (least < 0.0 ? least : 0.0);
      most = terms[k] + (most > 0.0 ? most : 0.0);
    }
    const double middle = 0.5 * (least + most), centre = n == 0 ? q[0] : middle, off = middle - centre;
    middles[n * free] = centre;
    radii[n * free] = 0.5 * (most - least) + (off < 0.0 ? -off : off) + others;
  }
}
#endif

/* Of coordinates, velocities and accelerations in the time tau > 0, given `count` rows of coefficients, which end with
 * zeros that fill up fours and are eight at least: middles of their ranges, and by how much they differ from these at
 * most. The middles of coordinates are where they start, whose sines and cosines are known.
 */
DALEMBERT_CLONES void dalembert_ranges(size_t free, size_t count, const double *q, const double *v, const double *a,
                                       double tau, double *middles, double *radii) {
  if (free == 1) {
    ranges(1, count, q, v, a, tau, middles, radii);
    return;
  }
  for (size_t i = 0; i < free; ++i) ranges(free, count, q + i, v + i, a + i, tau, middles + i, radii + i);
}
