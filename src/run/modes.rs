//! Names of what is recorded as the mode of a run.

use crate::model::{ContactSets, Variant};
use std::borrow::Cow;

/// The names of the modes of a run, by their numbers; where contacts make them these are all sets of contact states, which are
/// too many to be listed, behind the mode by hand where there are several.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ModeNames {
    modes: Vec<String>,
    sets: Option<ContactSets>,
}

impl ModeNames {
    /// Those of a variant.
    pub fn of(variant: &Variant) -> Self {
        ModeNames {
            modes: variant.modes.iter().map(|m| m.name.to_owned()).collect(),
            sets: variant.modes[0].contacts.as_ref().map(|c| c.sets().clone()),
        }
    }

    /// Some names.
    pub fn listed(modes: Vec<String>) -> Self {
        ModeNames { modes, sets: None }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        match &self.sets {
            None => self.modes.len(),
            Some(sets) => self.modes.len() * sets.count(),
        }
    }

    /// That of a number.
    ///
    /// # Panics
    /// If there is no such mode.
    pub fn name(&self, mode: usize) -> Cow<'_, str> {
        match &self.sets {
            None => Cow::Borrowed(&*self.modes[mode]),
            Some(sets) => {
                let set = sets.name(mode % sets.count());
                Cow::Owned(match &*self.modes {
                    [_] => set,
                    modes => format!("{}, {set}", modes[mode / sets.count()]),
                })
            }
        }
    }

    /// The number of a name.
    pub fn number(&self, name: &str) -> Option<usize> {
        match &self.sets {
            None => self.modes.iter().position(|mode| mode == name),
            Some(sets) => {
                let [_] = &*self.modes else {
                    let (mode, set) = name.split_once(", ")?;
                    let mode = self.modes.iter().position(|known| known == mode)?;
                    return Some(mode * sets.count() + sets.number(set)?);
                };
                sets.number(name)
            }
        }
    }
}
