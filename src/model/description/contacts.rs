//! Contacts and constraints of a mode.

use super::{Read, Reader};
use crate::kernel::ModeKernel;
use crate::model::reader::{At, text, truth};
use crate::model::{Constraint, Contact, ContactSets, Contacts, DeclaredContact};
use crate::numerics::Dynamic;

impl Reader<'_> {
    /// The contacts of a mode with so many guards: first three of each contact, then those of transitions by hand.
    pub(super) fn contacts(
        &self,
        at: &At,
        guards: usize,
        kernel: ModeKernel<Dynamic>,
    ) -> Read<Contacts> {
        let (coordinates, discretes) = (self.dimensions.coordinates, self.dimensions.discretes);
        let count = at.get("contacts", |at| {
            let count = at.list(|_| Ok(()))?.len();
            match Contacts::GUARDS * count <= guards {
                true => Ok(count),
                false => Err(at.wrong(format!("contacts with three of {guards} guards each"))),
            }
        })?;
        let contact = |at: &At| {
            let coordinate = |key| at.get(key, |at| at.option(|at| at.index(coordinates)));
            let discrete = |key| at.get(key, |at| at.option(|at| at.index(discretes)));
            Ok(Contact {
                name: at.get("name", text)?,
                is_ratchet: at.get("is_ratchet", truth)?,
                normal: coordinate("normal")?,
                tangent: coordinate("tangent")?,
                closed: discrete("closed")?,
                direction: discrete("direction")?,
                shares: discrete("shares")?,
                dropped: discrete("dropped")?,
                at_limit: discrete("at_limit")?,
                joined: at.get("joined", |at| {
                    at.list_of(count, |at| at.option(|at| at.index(discretes)))
                })?,
                law: at.get("law", |at| at.list(|at| at.index(coordinates)))?,
                held_law: at.get("held_law", |at| at.list(|at| at.index(coordinates)))?,
            })
        };
        let constraint = |at: &At| {
            Ok(Constraint {
                name: at.get("name", text)?,
                multiplier: at.get("multiplier", |at| at.index(coordinates))?,
                shares: at.get("shares", |at| at.option(|at| at.index(discretes)))?,
            })
        };
        let contacts: Box<[Contact]> = at.get("contacts", |at| at.list_of(count, contact))?;
        let decisions = at.get("decisions", |at| self.tape(at, Contacts::DECISIONS * count))?;
        Ok(Contacts {
            follows_motion: Contacts::follow_motion(&contacts, &decisions),
            kernel,
            moved: at.get("moved", truth)?,
            sets: ContactSets::new(&contacts),
            contacts,
            constraints: at.get("constraints", |at| at.list(constraint))?,
            decisions,
        })
    }
}

/// A contact as it is declared.
pub(super) fn declared(at: &At) -> Read<DeclaredContact> {
    let given = |key| at.get(key, |at| at.option(text));
    Ok(DeclaredContact {
        name: at.get("name", text)?,
        kind: at.get("kind", text)?,
        gap: given("gap")?,
        slip: given("slip")?,
        normal: given("normal")?,
        friction: [given("static")?, given("kinetic")?],
        restitution: given("restitution")?,
        states: at.get("states", |at| at.list(text))?,
    })
}
