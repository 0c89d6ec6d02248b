// The events of the walking tank for Python: start and transition, with the mode and the discrete states after it.
#include "tank.hpp"

template <bool FREE> struct Events {
  inline static Tank<FREE> tank;
  static int after(double *discrete) {
    std::copy(tank.discrete, tank.discrete + DISCRETES, discrete);
    return tank.mode;
  }
};
extern "C" int tank_start(bool free, double *y, double tolerance, double *discrete) {
  if (free) { Events<true>::tank.start(y, tolerance); return Events<true>::after(discrete); }
  Events<false>::tank.start(y, tolerance);
  return Events<false>::after(discrete);
}
extern "C" int tank_event(bool free, double t, double *y, int which, double *discrete) {
  if (free) { Events<true>::tank.event(t, y, which); return Events<true>::after(discrete); }
  Events<false>::tank.event(t, y, which);
  return Events<false>::after(discrete);
}
// What a call from Python costs.
extern "C" int tank_idle(bool, double, double *, int, double *) { return 0; }
