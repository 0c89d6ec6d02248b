//! The functions of a compiled model, typed: places in its tables become what the engine calls.

use super::{Read, Reader};
use crate::kernel::{
    ConstantsKernel, Functions, LaneKernel, ModeFunctions, ModeKernel, ModeKernels, Raw,
    SeriesKernel,
};
use crate::model::Guard;
use crate::model::reader::{At, count, truth};
use crate::numerics::{Const, Dynamic, Size};

/// How many results functions of a mode have.
#[derive(Clone, Copy)]
pub(super) struct Counts {
    /// Of what must hold, and of the margins.
    pub required: usize,
    pub outputs: usize,
}

impl Reader<'_> {
    pub(super) fn kernels(
        &self,
        at: &At,
        free: usize,
        guards: &[Guard],
        counts: Counts,
    ) -> Read<ModeKernels> {
        Ok(match free {
            _ if self.dynamic => {
                ModeKernels::Any(self.kernel(at, Dynamic(free), guards, counts)?)
            }
            0 => ModeKernels::F0(self.kernel(at, Const, guards, counts)?),
            1 => ModeKernels::F1(self.kernel(at, Const, guards, counts)?),
            2 => ModeKernels::F2(self.kernel(at, Const, guards, counts)?),
            3 => ModeKernels::F3(self.kernel(at, Const, guards, counts)?),
            4 => ModeKernels::F4(self.kernel(at, Const, guards, counts)?),
            5 => ModeKernels::F5(self.kernel(at, Const, guards, counts)?),
            6 => ModeKernels::F6(self.kernel(at, Const, guards, counts)?),
            _ => ModeKernels::Any(self.kernel(at, Dynamic(free), guards, counts)?),
        })
    }

    pub(super) fn kernel<F: Size>(
        &self,
        at: &At,
        size: F,
        guards: &[Guard],
        counts: Counts,
    ) -> Read<ModeKernel<F>> {
        let series = |key: &str| at.get(key, |at| self.series(at, self.functions));
        let lanes = match at.get("goes_in_lanes", truth)? {
            true => self.lanes,
            false => &[],
        };
        let general = guards.iter().any(Guard::is_general);
        let lanes = lanes.iter().map(|functions| {
            let series = |key: &str| at.get(key, |at| self.series(at, functions));
            Ok(LaneKernel {
                series: series("series")?,
                autonomous_series: series("autonomous_series")?,
                guard_series: general.then(|| series("guard_series")).transpose()?,
                requirement_bounds: at.get("requirement_bounds", |at| {
                    in_lanes(at, self.functions, functions)
                })?,
            })
        });
        let rows = guards.len() + at.get("beside_guards", count)?;
        Ok(ModeKernel {
            size,
            dimensions: self.dimensions.clone(),
            functions: ModeFunctions::find(|key| at.get(key, |at| self.value(at)))?,
            outputs: counts.outputs,
            requirements: counts.required,
            contact_values: at.get("contact_values", |at| at.option(|at| self.counted(at)))?,
            carried: at.get("carried", |at| at.option(|at| self.counted(at)))?,
            lines: at.get("lines", |at| at.option(|at| self.counted(at)))?,
            roundings: at.get("roundings", |at| at.option(|at| self.counted(at)))?,
            series: series("series")?,
            autonomous_series: series("autonomous_series")?,
            guard_series: series("guard_series")?,
            guards: rows,
            swinging: at.get("swinging", |at| at.list(|at| at.index(rows)))?,
            mass_is_constant: at.get("mass_is_constant", truth)?,
            inertia_is_fixed: at.get("inertia_is_fixed", truth)?,
            is_linear: at.get("is_linear", truth)?,
            lanes: lanes.collect::<Read<_>>()?,
        })
    }

    /// A function that says how many results it has.
    pub(super) fn counted(&self, at: &At) -> Read<(Raw, usize)> {
        let function = at.get("function", |at| self.value(at))?;
        Ok((function, at.get("count", count)?))
    }

    /// A function of values by its place.
    pub(super) fn value(&self, at: &At) -> Read<Raw> {
        let values = &self.functions.values;
        let found = values[at.index(values.len())?];
        found.ok_or_else(|| at.wrong("the place of a function that is there"))
    }

    /// The same for lanes, at each level.
    pub(super) fn in_lanes(&self, at: &At) -> Read<Box<[Option<Raw>]>> {
        let place = at.index(self.functions.values.len())?;
        Ok(self.lanes.iter().map(|of| of.values[place]).collect())
    }

    /// A function of parameters with so many results.
    pub(super) fn of_parameters(&self, at: &At, results: usize) -> Read<ConstantsKernel> {
        Ok(ConstantsKernel {
            dimensions: self.dimensions.clone(),
            function: at.get("function", |at| self.value(at))?,
            count: at.get("count", |at| match count(at)? {
                count if count == results => Ok(count),
                _ => Err(at.wrong(results.to_string())),
            })?,
        })
    }

    fn series(&self, at: &At, functions: &Functions) -> Read<SeriesKernel> {
        let (start, run) = at.get("functions", |at| {
            let found = functions.series[at.index(functions.series.len())?];
            found.ok_or_else(|| at.wrong("the place of functions that are there"))
        })?;
        Ok(SeriesKernel {
            start,
            run,
            lead: at.get("lead", count)?,
            row: at.get("row", count)?,
            convolutions: at.get("convolutions", count)?,
            ends: at.get("ends", truth)?,
        })
    }
}

/// A function for lanes.
fn in_lanes(at: &At, functions: &Functions, of_level: &Functions) -> Read<Raw> {
    let found = of_level.values[at.index(functions.values.len())?];
    found.ok_or_else(|| at.wrong("the place of a function that is there for lanes, too"))
}
