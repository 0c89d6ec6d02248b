/* Sums by a triangular table, four side by side: the Bernstein coefficients of a polynomial are such. */
#include "vectors.h"

/* As many coefficients as the highest order has. */
enum { MOST = 36 };

void dalembert_triangular_sums(size_t n, const double *factors, const double *table, double *out);

#if DALEMBERT_BLOCK == 4
/* Of a number that the compiler knows: each factor is read once for all columns. */
static inline __attribute__((always_inline)) void sums_of(const size_t n, const double *factors, const double *table,
                                                          double *out) {
  dalembert_block sums[MOST / 4] = {{0.0}};
#pragma GCC unroll 36
  for (size_t k = 0; k < n; ++k)
#pragma GCC unroll 9
    for (size_t block = k / 4; block < n / 4; ++block)
      sums[block] += factors[k] * ((const dalembert_block *)(table + n * k))[block];
#pragma GCC unroll 9
  for (size_t block = 0; block < n / 4; ++block) ((dalembert_block *)out)[block] = sums[block];
}
#endif

/* out[j] = sum over k <= j of factors[k] * table[n k + j], in this order; the table is zero for k > j. */
DALEMBERT_CLONES void dalembert_triangular_sums(size_t n, const double *factors, const double *table, double *out) {
#if DALEMBERT_BLOCK == 4
  switch (n) {
#define CASE(n) case n: sums_of(n, factors, table, out); return;
    CASE(4) CASE(8) CASE(12) CASE(16) CASE(20) CASE(24) CASE(28) CASE(32) CASE(MOST)
#undef CASE
  }
#endif
  for (size_t j = 0; j < n; ++j) {
    double sum = 0.0;
    for (size_t k = 0; k <= j; ++k) sum += factors[k] * table[n * k + j];
    out[j] = sum;
  }
}
