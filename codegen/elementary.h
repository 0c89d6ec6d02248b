/* Sine and cosine of an angle that needs no long reduction: shared by elementary.c, for one angle, and
 * lanes.h, for several. See elementary.c for what is promised and why.
 */
#include <stdint.h>
#include <string.h>

struct dalembert_pair { double sin, cos; };

static inline uint64_t bits_of(double x) { uint64_t b; memcpy(&b, &x, sizeof b); return b; }
static inline double of_bits(uint64_t b) { double x; memcpy(&x, &b, sizeof x); return x; }

/* An angle within a quarter turn about a multiple n of pi/2: near + far, |far| <= ulp(near)/2. */
struct angle { double near, far; uint64_t n; };

/* pi/2 in parts of 27 bits, and what is left. */
static const double P1 = 0x1.921fb54p+0, P2 = 0x1.10b461p-30, P3 = 0x1.a62633p-58, P4 = 0x1.45c06ep-86,
                    P5 = 0x1.cd129024e088ap-115;

/* Up to here n has 26 bits, and its products with the parts of pi/2 are exact. */
static const double DIRECT = 0x1p26;

/* Up to here, pi/4, nothing is to be reduced. */
static const double NEAR = 0x1.921fb54442d18p-1;

/* a + b = sum + what is returned, exactly (Knuth). */
static inline double two_sum(double a, double b, double *sum) {
  const double s = a + b, from_a = s - b, from_b = s - from_a;
  *sum = s;
  return (a - from_a) + (b - from_b);
}

/* For 0 <= x <= DIRECT (Cody and Waite 1980). */
static inline struct angle reduced_in_parts(double x) {
  /* To the nearest whole number, which the last bits then show. */
  const double round = 0x1.8p52, shifted = x * 0x1.45f306dc9c883p-1 + round, n = shifted - round;
  double sum = x - n * P1; /* exact: Sterbenz */
  double rest;
  if (sum > n * 0x1p-28 || -sum > n * 0x1p-28) {
    /* Nothing cancels: n P2 is smaller than the sum, and what is neglected is 2^-82 of it. */
    const double before = sum, part = n * P2;
    sum = before - part;
    rest = ((before - sum) - part) - n * (P3 + P4);
  } else {
    /* No multiple of pi/2 is closer to such a double than about 2^-58; the parts leave out n 2^-168. */
    rest = two_sum(sum, -(n * P2), &sum);
    rest += two_sum(sum, -(n * P3), &sum);
    rest += two_sum(sum, -(n * P4), &sum) - n * P5;
  }
  struct angle angle;
  angle.near = sum + rest;
  angle.far = (sum - angle.near) + rest;
  angle.n = bits_of(shifted);
  return angle;
}

/* The same, earlier where nothing is to be reduced. */
static inline struct angle reduced(double x) {
  if (x <= NEAR) {
    const struct angle itself = {x, 0.0, 0};
    return itself;
  }
  return reduced_in_parts(x);
}

/* `sign` is the sign bit of the angle that was reduced. */
static inline struct dalembert_pair sin_cos_of(struct angle angle, uint64_t sign) {
  struct dalembert_pair out;
  const double y = angle.near, far = angle.far, z = y * y, cube = z * y, fourth = z * z;
  const double s = 0x1.1111111110bb2p-7 + z * (-0x1.a01a019e83816p-13 + z * 0x1.71de379654304p-19)
                   + fourth * z * (-0x1.ae600aca92c64p-26 + z * 0x1.5e0b05bff20f2p-33);
  const double c = z * (0x1.5555555555555p-5 + z * (-0x1.6c16c16c16967p-10 + z * 0x1.a01a019f4e9b4p-16))
                   + fourth * fourth * (-0x1.27e4fa17bf139p-22 + z * (0x1.1eeb68cd22f56p-29 + z * -0x1.907d8f29fe831p-37));
  const double sin_y = y - ((z * (0.5 * far - cube * s) - far) - cube * -0x1.5555555555555p-3);
  const double half = 0.5 * z, one = 1.0 - half;
  const double cos_y = one + (((1.0 - one) - half) + (z * c - y * far));
  /* Odd multiples of a quarter turn exchange the two; the second bit of n is their sign. */
  const uint64_t odd = -(angle.n & 1), either = (bits_of(sin_y) ^ bits_of(cos_y)) & odd;
  out.sin = of_bits(bits_of(sin_y) ^ either ^ (angle.n & 2) << 62 ^ sign);
  out.cos = of_bits(bits_of(cos_y) ^ either ^ ((angle.n + 1) & 2) << 62);
  return out;
}
