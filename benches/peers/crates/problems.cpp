// The problems of problems.hpp for other languages: a table of plain functions.
#include "../problems.hpp"

struct Problem {
  const char *name;
  int states, guards;
  double end;
  const double *scales;
  void (*start)(double *y, double tolerance);
  void (*rhs)(double t, const double *y, double *f);
  void (*jacobian)(double t, const double *y, double *j);  // in rows
  void (*values)(double t, const double *y, double *g);    // of the guards
  bool (*event)(double t, double *y, int which);
};

template <class P> struct Plain {
  inline static P problem;
  static constexpr Problem TABLE{
      P::NAME, P::N, P::GUARDS, P::END, P::SCALES.data(),
      [](double *y, double tolerance) { problem.start(y, tolerance); },
      [](double t, const double *y, double *f) { problem.rhs(t, y, f); },
      [](double t, const double *y, double *j) { problem.jacobian(t, y, reinterpret_cast<double(*)[P::N]>(j)); },
      [](double t, const double *y, double *g) { problem.guards(t, y, g); },
      [](double t, double *y, int which) { return problem.event(t, y, which); }};
};

extern "C" const Problem peers_problems[] = {
    Plain<RockingBlock<false>>::TABLE, Plain<RockingBlock<true>>::TABLE, Plain<Belt>::TABLE,       Plain<Sliding<false>>::TABLE,
    Plain<Sliding<true>>::TABLE,       Plain<Ball>::TABLE,               Plain<Tank<true>>::TABLE, Plain<Tank<false>>::TABLE};
