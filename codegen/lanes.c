/* Sine and cosine of several angles, for the inputs of trajectories side by side. */
#include "lanes.h"

void LANES(dalembert_sin_cos_of_lanes)(const real *x, real *sine, real *cosine);
void LANES(dalembert_sin_cos_of_lanes)(const real *x, real *sine, real *cosine) {
  const struct dalembert_sin_cos pair = dalembert_sin_cos(*x);
  *sine = pair.sin;
  *cosine = pair.cos;
}
