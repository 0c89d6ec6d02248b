// The Fortran codes LSODAR (which finds roots itself) and RADAU5 (roots on its dense output, here), as
// built into libsiconos_externals.
#include "problems.hpp"
#include <limits>

extern "C" {
using LsodaF = void(int *, double *, double *, double *);
using LsodaJ = void(int *, double *, double *, int *, int *, double *, int *);
using LsodaG = void(int *, double *, double *, int *, double *);
void dlsodar_(LsodaF *, int *, double *, double *, double *, int *, double *, double *, int *, int *, int *, double *, int *, int *, int *, LsodaJ *, int *, LsodaG *, int *, int *);
using RadauF = void(int *, double *, double *, double *, double *, int *);
using RadauJ = void(int *, double *, double *, double *, int *, double *, int *);
using RadauM = void(int *, double *, int *, double *, int *);
using RadauOut = void(int *, double *, double *, double *, double *, int *, int *, double *, int *, int *);
void radau5_(int *, RadauF *, double *, double *, double *, double *, double *, double *, int *, RadauJ *, int *, int *, int *, RadauM *, int *, int *, int *, RadauOut *, int *,
             double *, int *, int *, int *, double *, int *, int *);
double contr5_(int *, double *, double *, int *);
}

static constexpr int STEPS = 5'000'000;

// The codes take plain functions: what these see is global.
template <class P> struct Global {
  inline static P problem;
  inline static long rhs, jacobians, steps;
  inline static double at_start[P::GUARDS], event_time, event_y[P::N];
  inline static int which;
  inline static bool found;

  static void f(int *, double *t, double *y, double *out) { ++rhs; problem.rhs(*t, y, out); }
  static void transposed(double t, double *y, double *out, int stride) {
    ++jacobians;
    double j[P::N][P::N];
    problem.jacobian(t, y, j);
    for (int r = 0; r < P::N; ++r) for (int c = 0; c < P::N; ++c) out[c * stride + r] = j[r][c];
  }
  static void j(int *, double *t, double *y, int *, int *, double *out, int *stride) { transposed(*t, y, out, *stride); }
  static void g(int *, double *t, double *y, int *, double *out) { problem.guards(*t, y, out); }
  static void radau_f(int *, double *t, double *y, double *out, double *, int *) { ++rhs; problem.rhs(*t, y, out); }
  static void radau_j(int *, double *t, double *y, double *out, int *stride, double *, int *) { transposed(*t, y, out, *stride); }
  static void mass(int *, double *, int *, double *, int *) {}

  // After a step: the earliest fall of a guard, looked for in the two halves of the step.
  static void after_step(int *number, double *from, double *to, double *y, double *dense, int *size, int *, double *, int *, int *stop) {
    double here[P::GUARDS];
    problem.guards(*to, y, here);
    if (*number > 1) {
      ++steps;
      double at[P::N], values[P::GUARDS];
      auto all = [&](double t) {
        for (int i = 1; i <= P::N; ++i) at[i - 1] = contr5_(&i, &t, dense, size);
        problem.guards(t, at, values);
      };
      const double middle = *from + (*to - *from) / 2;
      double in_middle[P::GUARDS];
      all(middle);
      std::copy(values, values + P::GUARDS, in_middle);
      event_time = std::numeric_limits<double>::infinity();
      for (int i = 0; i < P::GUARDS; ++i) {
        auto value = [&](double t) { all(t); return values[i]; };
        double t = event_time, left = *from, at_left = at_start[i];
        // A guard that starts at zero rises first: at some fraction of the step, unless rounding hides it.
        for (double length = middle - *from; at_start[i] == 0 && in_middle[i] < 0 && at_left <= 0 && *from + length > *from;) {
          left = *from + (length /= 2);
          at_left = value(left);
        }
        if (at_left > 0 && in_middle[i] < 0) t = fall(value, left, at_left, middle, in_middle[i]);
        else if (in_middle[i] > 0 && here[i] < 0) t = fall(value, middle, in_middle[i], *to, here[i]);
        if (t < event_time) { event_time = t; which = i; }
      }
      found = event_time <= *to;
      if (found) {
        all(event_time);
        std::copy(at, at + P::N, event_y);
        *stop = -1;
        return;
      }
    }
    std::copy(here, here + P::GUARDS, at_start);
  }
  // The first number at which a value is not positive, by bisection with secants.
  template <class Value> static double fall(Value value, double left, double at_left, double right, double at_right) {
    for (bool bisect = false;; bisect = !bisect) {
      double t = bisect ? left + (right - left) / 2 : left + (right - left) * (at_left / (at_left - at_right));
      if (!(t > left && t < right)) t = left + (right - left) / 2;
      if (!(t > left && t < right)) return right;
      const double here = value(t);
      (here > 0 ? left : right) = t;
      (here > 0 ? at_left : at_right) = here;
    }
  }
};

template <class P> void lsodar(double tolerance) {
  using G = Global<P>;
  measure("LSODAR", "Adams/BDF", P::NAME, tolerance, [&](Run &run) {
    double absolute[P::N], y[P::N], work[400] = {}, end = P::END;
    int integers[64] = {}, n = P::N, vectors = 2, to_stop = 4, state = 1, options = 1, size = 400, integer_size = 64, jacobian = 1, guards = P::GUARDS, found[P::GUARDS];
    for (int i = 0; i < P::N; ++i) absolute[i] = tolerance * P::SCALES[i];
    G::rhs = G::jacobians = 0;
    G::problem.start(y, tolerance);
    for (;;) {
      work[0] = P::END;
      integers[5] = STEPS;
      dlsodar_(G::f, &n, y, &run.time, &end, &vectors, &tolerance, absolute, &to_stop, &state, &options, work, &size, integers, &integer_size, G::j, &jacobian, G::g, &guards, found);
      run.steps += integers[10];
      if (state < 0) run.status = state;
      if (state != 3) break;
      run.events.push_back(run.time);
      const int which = std::find(found, found + P::GUARDS, 1) - found;
      if (G::problem.event(run.time, y, which) || run.runaway()) break;
      state = 1;
      std::fill(work + 4, work + 10, 0.0);
      std::fill(integers + 4, integers + 10, 0);
    }
    run.rhs = G::rhs;
    run.jacobians = G::jacobians;
    run.y.assign(y, y + P::N);
  });
}

template <class P> void radau5(double tolerance) {
  using G = Global<P>;
  measure("RADAU5", "Radau IIA 5", P::NAME, tolerance, [&](Run &run) {
    // The first step after an event as the code's documentation advises for stiff equations.
    const double first = std::string_view(P::NAME) == "P4S" ? 1e-7 : 1e-4;
    double absolute[P::N], relative[P::N], y[P::N], work[400], unused = 0;
    int integers[64], n = P::N, vectors = 1, given = 1, output = 1, size = 400, integer_size = 64, unused_int = 0, flag = 0;
    G::rhs = G::jacobians = G::steps = 0;
    G::problem.start(y, tolerance);
    for (;;) {
      std::fill(work, work + 20, 0.0);
      std::fill(integers, integers + 20, 0);
      integers[1] = STEPS;
      G::found = false;
      // The code writes to its tolerances and bandwidths.
      for (int i = 0; i < P::N; ++i) { absolute[i] = tolerance * P::SCALES[i]; relative[i] = tolerance; }
      int lower = P::N, upper = 0, no_mass = 0, mass_lower = P::N, mass_upper = 0;
      double end = P::END, step = first;
      radau5_(&n, G::radau_f, &run.time, y, &end, &step, relative, absolute, &vectors, G::radau_j, &given, &lower, &upper, G::mass, &no_mass, &mass_lower, &mass_upper, G::after_step, &output, work, &size,
              integers, &integer_size, &unused, &unused_int, &flag);
      if (flag < 0) run.status = flag;
      if (flag < 0 || !G::found) break;
      run.time = G::event_time;
      std::copy(G::event_y, G::event_y + P::N, y);
      run.events.push_back(run.time);
      if (G::problem.event(run.time, y, G::which) || run.runaway()) break;
    }
    run.steps = G::steps;
    run.rhs = G::rhs;
    run.jacobians = G::jacobians;
    run.y.assign(y, y + P::N);
  });
}

int main(int count, char **names) {
  each(count, names, []<class P>(double tolerance) {
    lsodar<P>(tolerance);
    radau5<P>(tolerance);
  });
}
