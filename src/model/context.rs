//! Contexts of a model.

use super::Model;
use crate::kernel::{Context, Rooms};
use crate::with_kernel;

impl Context {
    /// A context for `model` with the constants of `parameters` (in the order of the model).
    ///
    /// # Panics
    /// If the number of parameters is not the model's.
    pub fn new(model: &Model, parameters: &[f64]) -> Self {
        let modes = || model.automata().flat_map(|variant| &variant.modes);
        let mut rooms = Rooms::default();
        for mode in modes() {
            let (workspace, guards) = with_kernel!(&mode.kernels, k => (k.workspace(), k.guards));
            rooms.workspace = rooms.workspace.max(workspace);
            rooms.guards = rooms.guards.max(guards);
        }
        let guards = modes().flat_map(|mode| &mode.guards);
        let transitions = guards.flat_map(|guard| &guard.transitions);
        rooms.conditions = transitions
            .map(|t| t.kernel.conditions())
            .max()
            .unwrap_or(0);
        let discrete = model.discretes.iter().map(|d| d.values[0]).collect();
        Context::with(&model.constants, rooms, discrete, parameters)
    }

    /// Goes over to other parameters.
    ///
    /// # Panics
    /// As [`Context::new`], and if it is another model.
    pub fn set_parameters(&mut self, model: &Model, parameters: &[f64]) {
        self.set_constants(&model.constants, parameters);
    }
}
