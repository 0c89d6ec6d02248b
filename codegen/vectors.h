/* Numbers side by side in a register, in C for any processor.
 */
#include <stddef.h>
#include <stdint.h> /* names the C library */

/* Twice, for processors with AVX2 and for others, of which the loader takes one: by the same bits. */
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__)
#define DALEMBERT_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define DALEMBERT_CLONES
#endif
/* As many as fit. */
#if defined(__GNUC__) || defined(__clang__)
#define DALEMBERT_BLOCK 4
typedef double dalembert_block __attribute__((vector_size(32), aligned(8), may_alias));
#else
#define DALEMBERT_BLOCK 1
typedef double dalembert_block;
#endif
