//! The rows of a study's table, and the files of finished cases that hold them while it goes on.
//!
//! A file is a digest of the key of its study, cases, and a digest of all that; it is written aside and renamed, so a file that
//! is there is whole.

use sha2::{Digest as _, Sha256};

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Status {
    /// At its end.
    Ok,
    /// Before its end, for a reason.
    Stopped,
    /// Its scene is not one.
    Refused,
}

impl Status {
    const ALL: [Status; 3] = [Status::Ok, Status::Stopped, Status::Refused];

    /// The word for it in tables.
    pub fn word(self) -> &'static str {
        match self {
            Status::Ok => "ok",
            Status::Stopped => "stopped",
            Status::Refused => "refused",
        }
    }
}

/// A run, as the table has it; what varies follows from the case.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Row {
    pub case: u64,
    /// The value along the path of an analysis; NaN for a single run.
    pub intensity: f64,
    /// Whether it failed, if the study says what that is and the run tells.
    pub failed: Option<bool>,
    /// Whether its tolerance leaves that open.
    pub undecided: bool,
    pub status: Status,
    /// Why it stopped or is no scene.
    pub reason: Option<String>,
    /// Time reached, s.
    pub t: f64,
    /// Number of transitions.
    pub events: u64,
    /// Number of places where the run cannot tell whether a guard falls; `None` where nobody looked, in the lanes of an ensemble.
    pub uncertain: Option<u64>,
    /// Steps, rejected steps, evaluations of residuals and Jacobians, factorizations.
    pub work: [u64; 5],
    /// The measures, NaN where there is none.
    pub values: Vec<f64>,
}

/// Stands in a file for a number of places that nobody looked for.
const NOT_LOOKED: u64 = u64::MAX;

/// What [`Row::work`] holds.
pub(crate) const WORK: [&str; 5] = [
    "steps",
    "rejected",
    "residual_evaluations",
    "jacobian_evaluations",
    "factorizations",
];

impl Row {
    /// A case whose scene is not one.
    pub fn refused(case: u64, intensity: f64, values: Vec<f64>, reason: String) -> Row {
        Row {
            case,
            intensity,
            failed: None,
            undecided: false,
            status: Status::Refused,
            reason: Some(reason),
            t: f64::NAN,
            events: 0,
            uncertain: Some(0),
            work: [0; 5],
            values,
        }
    }

    fn write(&self, out: &mut Vec<u8>) {
        let mut put = |bytes: &[u8]| out.extend_from_slice(bytes);
        put(&self.intensity.to_bits().to_le_bytes());
        put(&[
            match self.failed {
                None => 2,
                Some(failed) => u8::from(failed),
            },
            u8::from(self.undecided),
            self.status as u8,
            u8::from(self.reason.is_some()),
        ]);
        put(&self.t.to_bits().to_le_bytes());
        let uncertain = self.uncertain.unwrap_or(NOT_LOOKED);
        for count in [self.events, uncertain].iter().chain(&self.work) {
            put(&count.to_le_bytes());
        }
        for value in &self.values {
            put(&value.to_bits().to_le_bytes());
        }
        let reason = self.reason.as_deref().unwrap_or("").as_bytes();
        put(&(reason.len() as u32).to_le_bytes());
        put(reason);
    }

    fn read(case: u64, measures: usize, from: &mut &[u8]) -> Option<Row> {
        let intensity = f64::from_bits(word(from)?);
        let [failed, undecided, status, has_reason] = *take(from, 4)? else {
            return None;
        };
        let t = f64::from_bits(word(from)?);
        let (events, uncertain) = (word(from)?, word(from)?);
        let mut work = [0; 5];
        for count in &mut work {
            *count = word(from)?;
        }
        let values: Option<Vec<f64>> = (0..measures)
            .map(|_| Some(f64::from_bits(word(from)?)))
            .collect();
        let length = u32::from_le_bytes(take(from, 4)?.try_into().ok()?);
        let reason = std::str::from_utf8(take(from, length as usize)?).ok()?;
        Some(Row {
            case,
            intensity,
            failed: (failed < 2).then_some(failed == 1),
            undecided: undecided == 1,
            status: *Status::ALL.get(usize::from(status))?,
            reason: (has_reason == 1).then(|| reason.to_owned()),
            t,
            events,
            uncertain: (uncertain != NOT_LOOKED).then_some(uncertain),
            work,
            values: values?,
        })
    }
}

fn take<'b>(from: &mut &'b [u8], count: usize) -> Option<&'b [u8]> {
    let (taken, rest) = from.split_at_checked(count)?;
    *from = rest;
    Some(taken)
}

fn word(from: &mut &[u8]) -> Option<u64> {
    Some(u64::from_le_bytes(take(from, 8)?.try_into().ok()?))
}

/// The contents of a file of finished cases, each with all its rows.
pub(crate) fn encode(key: &str, cases: &[(u64, Vec<Row>)]) -> Vec<u8> {
    let mut out = Sha256::digest(key).to_vec();
    for (case, rows) in cases {
        out.extend(case.to_le_bytes());
        out.extend((rows.len() as u32).to_le_bytes());
        rows.iter().for_each(|row| row.write(&mut out));
    }
    let digest = Sha256::digest(&out);
    out.extend(digest);
    out
}

/// Why a file of finished cases cannot be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Unusable {
    /// It is of a study with another key.
    OtherStudy,
    /// It is not as it was written.
    Damaged,
}

/// The cases of a file.
pub(crate) fn decode(
    key: &str,
    measures: usize,
    contents: &[u8],
) -> Result<Vec<(u64, Vec<Row>)>, Unusable> {
    const DIGEST: usize = 32;
    let split = contents
        .len()
        .checked_sub(DIGEST)
        .filter(|at| *at >= DIGEST);
    let (body, digest) = contents.split_at(split.ok_or(Unusable::Damaged)?);
    if Sha256::digest(body).as_slice() != digest {
        return Err(Unusable::Damaged);
    }
    let (of, mut rest) = body.split_at(DIGEST);
    if Sha256::digest(key).as_slice() != of {
        return Err(Unusable::OtherStudy);
    }
    let mut cases = Vec::new();
    let mut next = || -> Option<(u64, Vec<Row>)> {
        let case = word(&mut rest)?;
        let count = u32::from_le_bytes(take(&mut rest, 4)?.try_into().ok()?);
        let rows: Option<Vec<Row>> = (0..count)
            .map(|_| Row::read(case, measures, &mut rest))
            .collect();
        Some((case, rows?))
    };
    while let Some(case) = next() {
        cases.push(case);
    }
    match rest.is_empty() {
        true => Ok(cases),
        false => Err(Unusable::Damaged),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cases() -> Vec<(u64, Vec<Row>)> {
        let row = Row {
            case: 7,
            intensity: 0.1,
            failed: Some(true),
            undecided: true,
            status: Status::Stopped,
            reason: Some("it leaves the ground µ".into()),
            t: 1.5,
            events: 3,
            uncertain: Some(1),
            work: [1, 2, 3, 4, 5],
            values: vec![-0.0, 5e-324],
        };
        let other = Row {
            failed: None,
            uncertain: None,
            reason: None,
            status: Status::Ok,
            ..row.clone()
        };
        vec![(7, vec![row, other]), (9, Vec::new())]
    }

    #[test]
    fn cases_are_read_as_they_were_written() {
        let contents = encode("key", &cases());
        assert_eq!(decode("key", 2, &contents), Ok(cases()));
        assert_eq!(decode("other", 2, &contents), Err(Unusable::OtherStudy));
    }

    #[test]
    fn a_damaged_file_is_none() {
        let contents = encode("key", &cases());
        for length in 0..contents.len() {
            assert_eq!(
                decode("key", 2, &contents[..length]),
                Err(Unusable::Damaged),
                "{length}"
            );
        }
        for i in 0..contents.len() {
            let mut changed = contents.clone();
            changed[i] ^= 1;
            assert_eq!(decode("key", 2, &changed), Err(Unusable::Damaged), "{i}");
        }
    }
}
