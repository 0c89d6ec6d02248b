//! Contacts and constraints that hold by multipliers: one mode for all sets of contact states.
//!
//! A multiplier is the acceleration of a coordinate on which nothing depends; its rate is the impulse delivered so far.
//! Which rows the equations of the mode consist of is said by discrete states.

use super::Tape;
use super::name::intern;
use crate::kernel::ModeKernel;
use crate::numerics::Dynamic;

/// A contact, a friction element, a ratchet or one equation of a constraint as the model declares it, for people.
#[derive(Debug, Clone)]
pub struct DeclaredContact {
    /// Name.
    pub name: &'static str,
    /// `contact`, `friction`, `ratchet` or `constraint`.
    pub kind: &'static str,
    /// Its gap, the rate of a ratchet, or what a constraint holds at zero; none of friction.
    pub gap: Option<&'static str>,
    /// The place along which it slips, or its slip rate.
    pub slip: Option<&'static str>,
    /// The normal force of friction without a gap.
    pub normal: Option<&'static str>,
    /// The coefficients of friction.
    pub friction: [Option<&'static str>; 2],
    /// Restitution.
    pub restitution: Option<&'static str>,
    /// What it can do: `open`, `closed`, `sticks`, `slides`, `free`, `engaged`, `holds`.
    pub states: Box<[&'static str]>,
}

impl DeclaredContact {
    /// Whether it is not switched off.
    pub fn is_there(&self) -> bool {
        !self.states.contains(&"switched off")
    }
}

/// The contacts and constraints of a mode.
#[derive(Debug)]
pub struct Contacts {
    /// The contacts, ratchets and friction without a gap, in the order of the file. Each has three guards, one behind the other,
    /// before those of transitions by hand: what
    /// pushes, or the gap (of a ratchet the rate) where it is open; what is left before it slips forwards, or its slip rate along its direction where it
    /// slides; what is left before it slips backwards.
    pub contacts: Box<[Contact]>,
    /// The constraints, one an equation.
    pub constraints: Box<[Constraint]>,
    /// Whether a gap or a constraint depends on how the ground moves.
    pub moved: bool,
    /// The functions of the mode, for any number of coordinates: what happens at an instant is compiled once.
    pub kernel: ModeKernel<Dynamic>,
    /// What the contacts can do.
    pub(super) sets: ContactSets,
    /// What decides whether a set of states may go on, [`Contacts::DECISIONS`] a contact: λ_N, g̈, what is left before it slips
    /// forwards and backwards, γ̇.
    pub decisions: Tape,
    /// Whether what some friction can hold depends on accelerations, beside normal forces.
    pub(crate) follows_motion: bool,
}

/// A contact with its coordinates and discrete states, by their indices.
#[derive(Debug)]
pub struct Contact {
    /// Name.
    pub name: &'static str,
    /// Whether it is one-sided in a rate: this takes the place of the rate of a gap, and there is no gap; it is closed where it is
    /// engaged.
    pub is_ratchet: bool,
    /// The multiplier of its gap; none of friction that has none.
    pub normal: Option<usize>,
    /// The multiplier of its friction, if it has any.
    pub tangent: Option<usize>,
    /// The discrete state that is 1 where it is closed, else 0; none of friction without a gap.
    pub closed: Option<usize>,
    /// The one that is the sign of its slip rate where it slides, else 0.
    pub direction: Option<usize>,
    /// The one that is 1 where its forces are not determined, but for what they and those of others come to together.
    pub shares: Option<usize>,
    /// The one that is 1 where others hold its slip.
    pub dropped: Option<usize>,
    /// The one that is, there, the direction of its friction where this is the most that it can hold; 0 where it is none.
    pub at_limit: Option<usize>,
    /// Of each contact, the one that is 1 where the friction of that contact is part of its own.
    pub joined: Box<[Option<usize>]>,
    /// The coordinates whose rates after its impacts the model states; empty where the general law holds.
    pub law: Box<[usize]>,
    /// The same where all friction of what touched before sticks.
    pub held_law: Box<[usize]>,
}

/// One equation of a constraint.
#[derive(Debug)]
pub struct Constraint {
    /// Name.
    pub name: &'static str,
    /// Its multiplier.
    pub multiplier: usize,
    /// The discrete state that is 1 where its force is not determined, but for what it and those of others come to together.
    pub shares: Option<usize>,
}

impl Contacts {
    /// Guards of each contact, which come before those of transitions by hand.
    pub const GUARDS: usize = 3;

    /// Results of the tape of decisions for each contact.
    pub const DECISIONS: usize = 5;

    /// Numbers that the function of contact values gives for each contact.
    pub const VALUES: usize = 10;

    /// The same for each constraint.
    pub const HELD: usize = 4;

    /// Whether a coordinate, by its index, is a multiplier.
    pub fn is_multiplier(&self, coordinate: usize) -> bool {
        let of_contact = |c: &Contact| [c.normal, c.tangent].contains(&Some(coordinate));
        self.contacts.iter().any(of_contact)
            || self.constraints.iter().any(|c| c.multiplier == coordinate)
    }

    /// Whether what some friction can hold depends on accelerations beside normal forces, given what decides.
    pub(super) fn follow_motion(contacts: &[Contact], decisions: &Tape) -> bool {
        let multipliers: Vec<usize> = (contacts.iter())
            .flat_map(|contact| contact.normal.into_iter().chain(contact.tangent))
            .collect();
        (0..contacts.len()).any(|k| {
            let forwards = decisions.results[k * Contacts::DECISIONS + 2];
            let accelerations = decisions.accelerations_of(forwards);
            accelerations.iter().any(|i| !multipliers.contains(i))
        })
    }

    /// The sets of contact states.
    pub fn sets(&self) -> &ContactSets {
        &self.sets
    }

    /// The set of contact states that discrete states say, by its number.
    pub fn set(&self, discrete: &[f64]) -> usize {
        let states = self.contacts.iter().map(|contact| contact.state(discrete));
        self.sets.of(states)
    }

    /// Names of all that can happen.
    pub fn events(&self) -> Vec<&'static str> {
        let of_contact = |contact: &Contact| {
            let gap: &[_] = match (contact.closed, contact.is_ratchet) {
                (Some(_), false) => &["strikes", "closes", "opens"],
                (Some(_), true) => &["strikes", "engages", "releases"],
                (None, _) => &[],
            };
            let slip: &[_] = match contact.tangent {
                Some(_) => &["slips", "sticks", "reverses"],
                None => &[],
            };
            let verbs = gap.iter().chain(slip).chain(&["stays"]);
            let named = verbs.map(|verb| intern(&format!("{} {verb}", contact.name)));
            named.collect::<Vec<_>>()
        };
        self.contacts.iter().flat_map(of_contact).collect()
    }
}

/// All sets of contact states, by their numbers: they are counted, and never listed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ContactSets {
    /// Of each contact its name, and what it can do.
    words: Box<[(&'static str, &'static [&'static str])]>,
}

impl ContactSets {
    /// Those of some contacts.
    pub(super) fn new(contacts: &[Contact]) -> Self {
        let words = contacts
            .iter()
            .map(|contact| (contact.name, contact.words()));
        ContactSets {
            words: words.collect(),
        }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.words.iter().map(|(_, words)| words.len()).product()
    }

    /// The number of a set, by what each contact does.
    fn of(&self, states: impl Iterator<Item = usize>) -> usize {
        let pairs = states.zip(&self.words);
        pairs.fold(0, |set, (state, (_, words))| set * words.len() + state)
    }

    /// The name of a set: `left sticks, right open`.
    pub fn name(&self, mut set: usize) -> String {
        let mut names = Vec::new();
        for (name, words) in self.words.iter().rev() {
            names.push(format!("{name} {}", words[set % words.len()]));
            set /= words.len();
        }
        names.reverse();
        match names.is_empty() {
            true => "moves".into(),
            false => names.join(", "),
        }
    }

    /// The number of a name.
    pub fn number(&self, name: &str) -> Option<usize> {
        if self.words.is_empty() {
            return (name == "moves").then_some(0);
        }
        let said: Vec<&str> = name.split(", ").collect();
        let state = |(said, (name, words)): (&&str, &(&str, &[&str]))| {
            let word = said.strip_prefix(name)?.strip_prefix(' ')?;
            words.iter().position(|known| *known == word)
        };
        let states: Option<Vec<usize>> = said.iter().zip(&self.words).map(state).collect();
        let states =
            states.filter(|states| states.len() == said.len() && said.len() == self.words.len())?;
        Some(self.of(states.into_iter()))
    }
}

impl Contact {
    /// Whether others are to hold its slip, by these discrete states.
    pub fn is_dropped(&self, discrete: &[f64]) -> bool {
        self.dropped.is_some_and(|i| discrete[i] != 0.0)
    }

    /// Whether it has a gap that closes: neither friction alone nor a ratchet does.
    pub fn has_gap(&self) -> bool {
        self.normal.is_some() && !self.is_ratchet
    }

    /// Which derivative of what is positive while it is open is an acceleration: the second of a gap, the first of a rate.
    pub fn derivative_of_acceleration(&self) -> usize {
        if self.is_ratchet { 1 } else { 2 }
    }

    /// What it can do.
    fn words(&self) -> &'static [&'static str] {
        match (self.closed, self.tangent) {
            _ if self.is_ratchet => &["free", "engaged"],
            (Some(_), Some(_)) => &["open", "sticks", "slides"],
            (Some(_), None) => &["open", "closed"],
            (None, _) => &["sticks", "slides"],
        }
    }

    /// What it does, by the index of the word.
    fn state(&self, discrete: &[f64]) -> usize {
        let open = self.closed.is_some_and(|i| discrete[i] == 0.0);
        let slides = self.direction.is_some_and(|i| discrete[i] != 0.0);
        match open {
            true => 0,
            false => usize::from(self.closed.is_some()) + usize::from(slides),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_of_contact_states_are_named_and_found_by_their_names() {
        let words: [(&str, &[&str]); 3] = [
            ("left", &["open", "sticks", "slides"]),
            ("clutch", &["free", "engaged"]),
            ("left heel", &["open", "closed"]),
        ];
        let sets = ContactSets {
            words: words.into(),
        };
        assert_eq!(sets.count(), 12);
        assert_eq!(sets.name(0), "left open, clutch free, left heel open");
        assert_eq!(
            sets.name(7),
            "left sticks, clutch engaged, left heel closed"
        );
        assert!((0..12).all(|set| sets.number(&sets.name(set)) == Some(set)));
        for other in [
            "",
            "moves",
            "left open",
            "left open, clutch free, left heel opens",
            "left open, clutch free, heel open",
        ] {
            assert_eq!(sets.number(other), None, "{other}");
        }
        // As many as sixteen contacts have are counted in no time.
        let many = ContactSets {
            words: vec![words[0]; 16].into(),
        };
        assert_eq!(many.count(), 43_046_721);
        assert_eq!(many.number(&many.name(31_415_926)), Some(31_415_926));
    }
}
