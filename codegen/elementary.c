/* Sine and cosine, by the same bits on every processor and with every mathematical library.
 *
 * Only +, -, x and conversions, each rounded as IEEE 754 says; nothing may be contracted
 * (-ffp-contract=off). The error is below one unit in the last place. Generated code and the inputs
 * of the library call this function alone, so that both see the same motion of the ground.
 *
 * x = n pi/2 + y with |y| <= pi/4 (Muller 2016, Elementary Functions, chapter 11); y is the sum of two
 * doubles. sin y and cos y are polynomials in y^2 (tools/elementary.py).
 */
#include <stdint.h>
#include <string.h>

struct dalembert_sin_cos { double sin, cos; };
struct dalembert_sin_cos dalembert_sin_cos(double x);

static uint64_t bits_of(double x) { uint64_t b; memcpy(&b, &x, sizeof b); return b; }
static double of_bits(uint64_t b) { double x; memcpy(&x, &b, sizeof x); return x; }

/* An angle within a quarter turn about a multiple n of pi/2: near + far, |far| <= ulp(near)/2. */
struct angle { double near, far; uint64_t n; };

/* pi/2 in parts of 27 bits, and what is left. */
static const double P1 = 0x1.921fb54p+0, P2 = 0x1.10b461p-30, P3 = 0x1.a62633p-58, P4 = 0x1.45c06ep-86,
                    P5 = 0x1.cd129024e088ap-115;

/* Up to here n has 26 bits, and its products with the parts of pi/2 are exact. */
static const double DIRECT = 0x1p26;

/* a + b = sum + what is returned, exactly (Knuth). */
static double two_sum(double a, double b, double *sum) {
  const double s = a + b, from_a = s - b, from_b = s - from_a;
  *sum = s;
  return (a - from_a) + (b - from_b);
}

/* For 0 <= x <= DIRECT (Cody and Waite 1980). */
static struct angle reduced(double x) {
  if (x <= 0x1.921fb54442d18p-1) { /* pi/4: what follows gives the same, later. */
    const struct angle itself = {x, 0.0, 0};
    return itself;
  }
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

/* 2/pi in words of 32 bits: 2^-32 times the first, 2^-64 times the second, ... */
static const uint32_t TWO_OVER_PI[] = {
  0xa2f9836e, 0x4e441529, 0xfc2757d1, 0xf534ddc0, 0xdb629599, 0x3c439041, 0xfe5163ab, 0xdebbc561,
  0xb7246e3a, 0x424dd2e0, 0x06492eea, 0x09d1921c, 0xfe1deb1c, 0xb129a73e, 0xe88235f5, 0x2ebb4484,
  0xe99c7026, 0xb45f7e41, 0x3991d639, 0x835339f4, 0x9c845f8b, 0xbdf9283b, 0x1ff897ff, 0xde05980f,
  0xef2f118b, 0x5a0a6d1f, 0x6d367ecf, 0x27cb09b7, 0x4f463f66, 0x9e5fea2d, 0x7527bac7, 0xebe5f17b,
  0x3d0739f7, 0x8a5292ea, 0x6bfb5fb1, 0x1f8d5d08, 0x56033046, 0xfc7b6bab, 0xf0cfbc20, 0x9af4361d,
};

/* For finite x > DIRECT (Payne and Hanek 1983). x = m 2^e with a whole number m of 53 bits. Of 2/pi
 * only seven words count: those before them make multiples of four, those after them less than
 * 2^-138. No double is closer than 2^-62 to a multiple of pi/2. */
static struct angle reduced_far(double x) {
  enum { WORDS = 7 };
  const uint64_t b = bits_of(x), m = (b & 0xfffffffffffff) | 0x10000000000000;
  const int e = (int)(b >> 52) - 1075, first = e < 2 ? 0 : (e - 2) / 32;
  /* m times the words; product[0] is the lowest. */
  uint32_t product[WORDS + 2] = {0};
  for (int part = 0; part < 2; ++part) {
    const uint64_t factor = part == 0 ? (uint32_t)m : m >> 32;
    uint64_t carry = 0;
    for (int i = 0; i < WORDS; ++i) {
      const uint64_t sum = factor * TWO_OVER_PI[first + WORDS - 1 - i] + product[i + part] + carry;
      product[i + part] = (uint32_t)sum;
      carry = sum >> 32;
    }
    product[WORDS + part] = (uint32_t)carry;
  }
  /* The binary point is at bit `point`; top[0] are the quarter turns, after it the fraction. */
  const int point = 32 * (first + WORDS) - e, word = point / 32, shift = point % 32;
  uint32_t top[6];
  for (int i = 0; i < 6; ++i) {
    const uint64_t pair = (uint64_t)(word - i + 1 < WORDS + 2 ? product[word - i + 1] : 0) << 32 | product[word - i];
    top[i] = (uint32_t)(pair >> shift);
  }
  /* To the nearest whole number: a fraction above one half becomes negative. */
  const int up = top[1] >> 31 != 0;
  const double unit = up ? -0x1p-32 : 0x1p-32;
  uint64_t carry = up;
  for (int i = 5; i >= 1 && up; --i) {
    carry += (uint32_t)~top[i];
    top[i] = (uint32_t)carry;
    carry >>= 32;
  }
  double high;
  double rest = two_sum(top[1] * unit, top[2] * (unit * 0x1p-32), &high);
  rest += top[3] * (unit * 0x1p-64) + (top[4] * (unit * 0x1p-96) + top[5] * (unit * 0x1p-128));
  /* Times pi/2, the first product exactly. */
  const double head = of_bits(bits_of(high) & ~(uint64_t)0x7ffffff), tail = (high - head) + rest;
  const double product_high = head * P1, product_low = tail * (P1 + P2) + head * (P2 + P3);
  struct angle angle;
  angle.near = product_high + product_low;
  angle.far = (product_high - angle.near) + product_low;
  angle.n = (uint64_t)top[0] + (uint64_t)up;
  return angle;
}

/* Not a number for x that is none or infinite. */
struct dalembert_sin_cos dalembert_sin_cos(double x) {
  const uint64_t sign = bits_of(x) & ((uint64_t)1 << 63);
  const double size = of_bits(bits_of(x) ^ sign);
  struct dalembert_sin_cos out;
  if (!(size < 0x1p1023 * 2.0)) {
    out.sin = out.cos = x - x;
    return out;
  }
  const struct angle angle = size <= DIRECT ? reduced(size) : reduced_far(size);
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
