// Rows of Siconos 4.4 (Debian): Moreau-Jean time stepping with theta = 1/2, contact laws solved by Lemke's method, which here never failed. Its
// event-driven integrators refuse impacts with friction. Prints problem, step, coordinates at the end, seconds, largest gap.

#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <SiconosKernel.hpp>
#include <vector>

using namespace std;
const double g = 9.81;

double now() { return chrono::duration<double>(chrono::steady_clock::now().time_since_epoch()).count(); }

SP::SiconosVector vec(vector<double> v) {
    SP::SiconosVector s(new SiconosVector(v.size()));
    for (size_t i = 0; i < v.size(); ++i) (*s)(i) = v[i];
    return s;
}

/// A body with a constant mass and a force of time.
struct Body : LagrangianDS {
    function<vector<double>(double)> force;
    Body(vector<double> q, vector<double> v, vector<double> mass, function<vector<double>(double)> force)
        : LagrangianDS(vec(q), vec(v)), force(force) {
        SP::SimpleMatrix m(new SimpleMatrix(mass.size(), mass.size()));
        m->zero();
        for (size_t i = 0; i < mass.size(); ++i) (*m)(i, i) = mass[i];
        setMassPtr(m);
        _fExt = vec(force(0));
        _hasConstantFExt = false;
    }
    void computeFExt(double t) override {
        auto value = force(t);
        for (size_t i = 0; i < value.size(); ++i) (*_fExt)(i) = value[i];
    }
};

/// A relation h(q) with its Jacobian, both written out.
struct Relation2 : LagrangianScleronomousR {
    typedef function<void(const BlockVector&, SiconosVector&)> Value;
    typedef function<void(const BlockVector&, SimpleMatrix&)> Jacobian;
    Value value;
    Jacobian jacobian;
    unsigned rows;
    Relation2(unsigned rows, Value value, Jacobian jacobian) : value(value), jacobian(jacobian), rows(rows) {}
    void initialize(Interaction& inter) override {
        unsigned size = inter.getSizeOfDS();
        _jachq.reset(new SimpleMatrix(rows, size));
        _jachq->zero();
        LagrangianR::initialize(inter);
    }
    void computeh(const BlockVector& q, BlockVector&, SiconosVector& y) override { value(q, y); }
    void computeJachq(const BlockVector& q, BlockVector&) override { jacobian(q, static_cast<SimpleMatrix&>(*_jachq)); }
    void computeDotJachq(const BlockVector&, BlockVector&, const BlockVector&) override {}
};

struct Run {
    double seconds = 1e300, gap = 0;
    vector<double> q;
};

/// Steps of the Moreau-Jean method; `gap` is asked after each.
void simulate(Run& run, SP::NonSmoothDynamicalSystem system, SP::OneStepNSProblem problem, double end, double h,
              function<double()> gap, function<vector<double>()> q) {
    SP::TimeDiscretisation time(new TimeDiscretisation(0, h));
    SP::MoreauJeanOSI method(new MoreauJeanOSI(0.5));
    SP::TimeStepping s(new TimeStepping(system, time, method, problem));
    s->setNewtonTolerance(1e-12);
    s->setNewtonMaxIteration(50);
    long steps = lround(end / h);
    double start = now();
    for (long k = 0; k < steps; ++k) {
        s->computeOneStep();
        run.gap = max(run.gap, gap());
        s->nextStep();
    }
    run.seconds = min(run.seconds, now() - start);
    run.q = q();
}

SP::OneStepNSProblem friction() {
    SP::FrictionContact f(new FrictionContact(2, SICONOS_FRICTION_2D_LEMKE));
    return f;
}

Run block(double h) {
    const double b = 0.2, hh = 0.4, m = 1, mu = 0.55, I = m * (b * b + hh * hh) / 3;
    SP::LagrangianDS body(new Body({b, hh, 0}, {0, 0, 0}, {m, m, I}, [=](double t) {
        return vector<double>{-m * 12 * sin(16 * t), -m * (g + 3 * sin(20 * t + 0.7)), 0};
    }));
    SP::NonSmoothDynamicalSystem system(new NonSmoothDynamicalSystem(0, 1e3));
    system->insertDynamicalSystem(body);
    for (double xi : {-b, b}) {
        SP::NonSmoothLaw law(new NewtonImpactFrictionNSL(0, 0, mu, 2));
        SP::Relation corner(new Relation2(2,
            [=](const BlockVector& q, SiconosVector& y) {
                y(0) = q(1) + xi * sin(q(2)) - hh * cos(q(2));
                y(1) = q(0) + xi * cos(q(2)) + hh * sin(q(2));
            },
            [=](const BlockVector& q, SimpleMatrix& j) {
                j(0, 0) = 0, j(0, 1) = 1, j(0, 2) = xi * cos(q(2)) + hh * sin(q(2));
                j(1, 0) = 1, j(1, 1) = 0, j(1, 2) = -xi * sin(q(2)) + hh * cos(q(2));
            }));
        system->link(SP::Interaction(new Interaction(law, corner)), body);
    }
    Run run;
    auto q = body->q();
    simulate(run, system, friction(), 2, h,
             [=] { double low = 1; for (double xi : {-b, b}) low = min(low, (*q)(1) + xi * sin((*q)(2)) - hh * cos((*q)(2))); return -low; },
             [=] { return vector<double>{(*q)(0), (*q)(1), (*q)(2)}; });
    return run;
}

Run stack(double h) {
    const double big = 3, small = 1;
    auto shaken = [](double m) { return [m](double t) { return vector<double>{-m * 6 * sin(7 * t), -m * g}; }; };
    SP::LagrangianDS a(new Body({0, 0}, {0, 0}, {big, big}, shaken(big))), c(new Body({0, 0}, {0, 0}, {small, small}, shaken(small)));
    SP::NonSmoothDynamicalSystem system(new NonSmoothDynamicalSystem(0, 1e3));
    system->insertDynamicalSystem(a);
    system->insertDynamicalSystem(c);
    SP::NonSmoothLaw table(new NewtonImpactFrictionNSL(0, 0, 0.3, 2)), top(new NewtonImpactFrictionNSL(0, 0, 0.2, 2));
    SP::Relation first(new Relation2(2, [](const BlockVector& q, SiconosVector& y) { y(0) = q(1), y(1) = q(0); },
                                     [](const BlockVector&, SimpleMatrix& j) { j(0, 1) = 1, j(1, 0) = 1; }));
    SP::Relation second(new Relation2(2, [](const BlockVector& q, SiconosVector& y) { y(0) = q(3) - q(1), y(1) = q(2) - q(0); },
                                      [](const BlockVector&, SimpleMatrix& j) { j(0, 1) = -1, j(0, 3) = 1, j(1, 0) = -1, j(1, 2) = 1; }));
    system->link(SP::Interaction(new Interaction(table, first)), a);
    system->link(SP::Interaction(new Interaction(top, second)), a, c);
    Run run;
    simulate(run, system, friction(), 3, h, [=] { return -min((*a->q())(1), (*c->q())(1) - (*a->q())(1)); },
             [=] { return vector<double>{(*a->q())(0), (*c->q())(0)}; });
    return run;
}

int main() {
    for (auto [name, solve] : {pair{"block", block}, pair{"stack", stack}})
        for (double h : {2e-3, 5e-4, 1e-4}) {
            try {
                Run run = solve(h);
                printf("%s,%g,%.3e,%.1e", name, h, run.seconds, run.gap);
                for (double q : run.q) printf(",%.17g", q);
                printf("\n");
            } catch (exception& failure) {
                fprintf(stderr, "# %s, step %g s: %s\n", name, h, failure.what());
            } catch (...) {
                fprintf(stderr, "# %s, step %g s: stopped\n", name, h);
            }
            fflush(stdout);
        }
}
