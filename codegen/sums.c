/* Sums by a triangular table, four side by side: the Bernstein coefficients of a polynomial are such. */
#include "vectors.h"

void dalembert_triangular_sums(size_t n, const double *factors, const double *table, double *out);

/* out[j] = sum over k <= j of factors[k] * table[n k + j], in this order; the table is zero for k > j. */
DALEMBERT_CLONES void dalembert_triangular_sums(size_t n, const double *factors, const double *table, double *out) {
  size_t from = 0;
#if DALEMBERT_BLOCK == 4
  for (; from + 4 <= n; from += 4) {
    const double *column = table + from;
    dalembert_block sums = {0.0};
    for (size_t k = 0; k < from + 4; k += 4) {
      sums += factors[k] * *(const dalembert_block *)column;
      sums += factors[k + 1] * *(const dalembert_block *)(column + n);
      sums += factors[k + 2] * *(const dalembert_block *)(column + 2 * n);
      sums += factors[k + 3] * *(const dalembert_block *)(column + 3 * n);
      column += 4 * n;
    }
    *(dalembert_block *)(out + from) = sums;
  }
#endif
  for (; from < n; ++from) {
    double sum = 0.0;
    for (size_t k = 0; k <= from; ++k) sum += factors[k] * table[n * k + from];
    out[from] = sum;
  }
}
