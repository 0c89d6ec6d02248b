/* Sine and cosine, by the same bits on every processor and with every mathematical library.
 *
 * Only +, -, x and conversions, each rounded as IEEE 754 says; nothing may be contracted
 * (-ffp-contract=off). The error is below one unit in the last place. Generated code and the inputs
 * of the library call this function alone, so that both see the same motion of the ground.
 *
 * x = n pi/2 + y with |y| <= pi/4 (Muller 2016, Elementary Functions, chapter 11); y is the sum of two
 * doubles. sin y and cos y are polynomials in y^2 (tools/elementary.py).
 */
#include "elementary.h"

struct dalembert_pair dalembert_sin_cos(double x);

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
struct dalembert_pair dalembert_sin_cos(double x) {
  const uint64_t sign = bits_of(x) & ((uint64_t)1 << 63);
  const double size = of_bits(bits_of(x) ^ sign);
  struct dalembert_pair out;
  if (!(size < 0x1p1023 * 2.0)) {
    out.sin = out.cos = x - x;
    return out;
  }
  const struct angle angle = size <= DIRECT ? reduced(size) : reduced_far(size);
  return sin_cos_of(angle, sign);
}
