/* Trajectories side by side: the names that generated code uses, for vectors of doubles.
 *
 * Every operation works on each lane as the scalar one does, rounding included; what the C library
 * computes it computes lane by lane. So a lane has the same bits on every processor, whatever the
 * others hold.
 *
 * The file is compiled once for each level of the processor: DALEMBERT_LEVEL is what the names of the
 * functions end with, DALEMBERT_LANES how many lanes a register has.
 */
#include <math.h>
#include <stddef.h>
#include "elementary.h"

typedef double real __attribute__((vector_size(8 * DALEMBERT_LANES), aligned(16)));
typedef real dalembert_block;
#define DALEMBERT_INLINE static inline __attribute__((always_inline))
#define DALEMBERT_CLONES
#define DALEMBERT_BLOCK 1
/* Has a block that is read from memory, and used twice, read once. */
#if DALEMBERT_LANES == 8
#define DALEMBERT_KEEP(block) __asm__("" : "+v"(block))
#else
#define DALEMBERT_KEEP(block)
#endif
#define DALEMBERT_PUT(at, ...) DALEMBERT_PUT_EACH(at, __VA_ARGS__)
#define DALEMBERT_JOIN(name, level) DALEMBERT_JOINED(name, level)
#define DALEMBERT_JOINED(name, level) name##level
#define LANES(name) DALEMBERT_JOIN(name, DALEMBERT_LEVEL)

/* A number in all lanes; a vector as it is (x - 0 is x, whatever its sign). */
#define REAL(x) ((x) - (real){0})

#define DALEMBERT_BY_LANE(name) \
  DALEMBERT_INLINE real dalembert_lanes_##name(real x) { \
    for (int i = 0; i < DALEMBERT_LANES; ++i) x[i] = name(x[i]); \
    return x; \
  }
#define DALEMBERT_BY_LANE_OF_TWO(name) \
  DALEMBERT_INLINE real dalembert_lanes_##name(real x, real y) { \
    for (int i = 0; i < DALEMBERT_LANES; ++i) x[i] = name(x[i], y[i]); \
    return x; \
  }
DALEMBERT_BY_LANE(sqrt) DALEMBERT_BY_LANE(fabs) DALEMBERT_BY_LANE(tan) DALEMBERT_BY_LANE(asin)
DALEMBERT_BY_LANE(acos) DALEMBERT_BY_LANE(atan) DALEMBERT_BY_LANE(exp) DALEMBERT_BY_LANE(log)
DALEMBERT_BY_LANE(sinh) DALEMBERT_BY_LANE(cosh) DALEMBERT_BY_LANE(tanh) DALEMBERT_BY_LANE(asinh)
DALEMBERT_BY_LANE(acosh) DALEMBERT_BY_LANE(atanh) DALEMBERT_BY_LANE(expm1) DALEMBERT_BY_LANE(log1p)
DALEMBERT_BY_LANE(erf) DALEMBERT_BY_LANE_OF_TWO(pow) DALEMBERT_BY_LANE_OF_TWO(atan2)
DALEMBERT_BY_LANE_OF_TWO(hypot) DALEMBERT_BY_LANE_OF_TWO(fmax)
#define sqrt(x) dalembert_lanes_sqrt(x)
#define fabs(x) dalembert_lanes_fabs(x)
#define tan(x) dalembert_lanes_tan(x)
#define asin(x) dalembert_lanes_asin(x)
#define acos(x) dalembert_lanes_acos(x)
#define atan(x) dalembert_lanes_atan(x)
#define exp(x) dalembert_lanes_exp(x)
#define log(x) dalembert_lanes_log(x)
#define sinh(x) dalembert_lanes_sinh(x)
#define cosh(x) dalembert_lanes_cosh(x)
#define tanh(x) dalembert_lanes_tanh(x)
#define asinh(x) dalembert_lanes_asinh(x)
#define acosh(x) dalembert_lanes_acosh(x)
#define atanh(x) dalembert_lanes_atanh(x)
#define expm1(x) dalembert_lanes_expm1(x)
#define log1p(x) dalembert_lanes_log1p(x)
#define erf(x) dalembert_lanes_erf(x)
#define pow(x, y) dalembert_lanes_pow(x, y)
#define atan2(x, y) dalembert_lanes_atan2(x, y)
#define hypot(x, y) dalembert_lanes_hypot(x, y)
#define fmax(x, y) dalembert_lanes_fmax(REAL(x), REAL(y))


/* Sine and cosine with the bits of elementary.c: the loops become ones of vectors where no angle needs the
 * long reduction, and short ones where none needs any. Where some do all take the same way, or the compiler would
 * have every lane go both.
 */
struct dalembert_pair dalembert_sin_cos(double x);
struct dalembert_sin_cos { real sin, cos; };
DALEMBERT_INLINE struct dalembert_sin_cos dalembert_lanes_sin_cos(real x) {
  double angle[DALEMBERT_LANES], sin[DALEMBERT_LANES], cos[DALEMBERT_LANES];
  memcpy(angle, &x, sizeof x);
  uint64_t most = 0; /* of the bits of their sizes, which are in the order of the numbers */
  for (int i = 0; i < DALEMBERT_LANES; ++i) {
    const uint64_t size = bits_of(angle[i]) & ~((uint64_t)1 << 63);
    most = size > most ? size : most;
  }
  const int near = most <= bits_of(NEAR), direct = most <= bits_of(DIRECT);
  for (int i = 0; near && i < DALEMBERT_LANES; ++i) {
    const uint64_t sign = bits_of(angle[i]) & (uint64_t)1 << 63;
    const struct angle itself = {of_bits(bits_of(angle[i]) ^ sign), 0.0, 0};
    const struct dalembert_pair pair = sin_cos_of(itself, sign);
    sin[i] = pair.sin;
    cos[i] = pair.cos;
  }
  for (int i = 0; !near && direct && i < DALEMBERT_LANES; ++i) {
    const uint64_t sign = bits_of(angle[i]) & (uint64_t)1 << 63;
    const struct angle reduced = reduced_in_parts(of_bits(bits_of(angle[i]) ^ sign));
    const struct dalembert_pair pair = sin_cos_of(reduced, sign);
    sin[i] = pair.sin;
    cos[i] = pair.cos;
  }
  for (int i = 0; !near && !direct && i < DALEMBERT_LANES; ++i) {
    const struct dalembert_pair pair = dalembert_sin_cos(angle[i]);
    sin[i] = pair.sin;
    cos[i] = pair.cos;
  }
  struct dalembert_sin_cos out;
  memcpy(&out.sin, sin, sizeof sin);
  memcpy(&out.cos, cos, sizeof cos);
  return out;
}
#define dalembert_sin_cos(x) dalembert_lanes_sin_cos(x)

/* Angles whose sines and cosines were computed last, as a function for one trajectory keeps them: those that a step
 * starts with are asked for again when it has ended. src/kernel/lanes.rs.
 */
struct dalembert_angle { real angle; struct dalembert_sin_cos pair; };
DALEMBERT_INLINE struct dalembert_sin_cos dalembert_kept_sin_cos(struct dalembert_angle *kept, real angle) {
  typedef unsigned long long word __attribute__((vector_size(8 * DALEMBERT_LANES), aligned(16)));
  const word differing = (word)kept->angle ^ (word)angle;
  uint64_t any = 0;
  for (int i = 0; i < DALEMBERT_LANES; ++i) any |= differing[i];
  if (any) {
    kept->pair = dalembert_lanes_sin_cos(angle);
    kept->angle = angle;
  }
  return kept->pair;
}
#define DALEMBERT_SIN_COS(n, angle) dalembert_kept_sin_cos(x->angles + (n), angle)
