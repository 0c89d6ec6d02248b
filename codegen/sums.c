/* Sums by a triangular table, four side by side: the Bernstein coefficients of a polynomial are such. */
#include <stddef.h>
#include <stdint.h> /* names the C library */

/* Twice, for processors with AVX2 and for others, of which the loader takes one: by the same bits. */
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__)
#define CLONES __attribute__((target_clones("avx2", "default")))
#else
#define CLONES
#endif

#if defined(__GNUC__) || defined(__clang__)
#define BLOCKS
typedef double block __attribute__((vector_size(32), aligned(8), may_alias));
#endif

void dalembert_triangular_sums(size_t n, const double *factors, const double *table, double *out);

/* out[j] = sum over k <= j of factors[k] * table[n k + j], in this order; the table is zero for k > j. */
CLONES void dalembert_triangular_sums(size_t n, const double *factors, const double *table, double *out) {
  size_t from = 0;
#ifdef BLOCKS
  for (; from + 4 <= n; from += 4) {
    const double *column = table + from;
    block sums = {0.0};
    for (size_t k = 0; k < from + 4; k += 4) {
      sums += factors[k] * *(const block *)column;
      sums += factors[k + 1] * *(const block *)(column + n);
      sums += factors[k + 2] * *(const block *)(column + 2 * n);
      sums += factors[k + 3] * *(const block *)(column + 3 * n);
      column += 4 * n;
    }
    *(block *)(out + from) = sums;
  }
#endif
  for (; from < n; ++from) {
    double sum = 0.0;
    for (size_t k = 0; k <= from; ++k) sum += factors[k] * table[n * k + from];
    out[from] = sum;
  }
}
