//! Times of samples from a column of rounded numbers.

use super::super::number::rounding;
use super::super::{Fault, Note, Times};
use super::Parts;

/// Times from their column, in units of `factor` s: with one step if there is one that gives every
/// time as it is rounded.
pub(super) fn times(
    column: &[(f64, &str)],
    factor: f64,
    known: Option<f64>,
    parts: &Parts,
    notes: &mut Vec<Note>,
) -> Result<Times, Fault> {
    for (i, pair) in column.windows(2).enumerate() {
        let [(before, _), (t, text)] = [pair[0], pair[1]];
        if t <= before {
            let message = format!("time {t} does not come after {before}, the time before");
            let place = parts.rows[i + 1].place(text);
            return Err(Fault::new(
                message,
                place,
                "times increase from line to line",
            ));
        }
    }
    let last = column.len() - 1;
    let (start, end) = (column[0].0, column[last].0);
    if last == 0 {
        return Ok(Times::Every {
            start: start * factor,
            dt: 1.0,
        });
    }
    let exact = |text: &str| rounding(&text.replace(',', "."));
    let written = column
        .iter()
        .map(|(_, text)| exact(text))
        .fold(f64::INFINITY, f64::min);
    // Times may have been summed up step by step, each sum rounded.
    let summed = f64::EPSILON * end.abs().max(start.abs()) * column.len() as f64;
    // The first time and the other one are both rounded.
    let room = 2.0 * written.max(summed);
    let (mut low, mut high) = (0.0_f64, f64::INFINITY);
    for (i, (t, _)) in column.iter().enumerate().skip(1) {
        low = low.max((t - start - room) / i as f64);
        high = high.min((t - start + room) / i as f64);
    }
    let place = parts.rows[0].range();
    if let Some(dt) = known {
        let own = dt / factor;
        let fits = low * (1.0 - f64::EPSILON) <= own && own <= high * (1.0 + f64::EPSILON);
        return if fits {
            Ok(Times::Every {
                start: start * factor,
                dt,
            })
        } else {
            let mean = (end - start) / last as f64 * factor;
            let message = format!("the step is said to be {dt} s, the times have {mean} s");
            Err(Fault::new(
                message,
                place,
                "leave out the step, or mend the times",
            ))
        };
    }
    if low > high {
        let step = |i: usize| column[i + 1].0 - column[i].0;
        let widest = (0..last).fold(0, |w, i| if step(i) > step(w) { i } else { w });
        let least = (0..last).map(step).fold(f64::INFINITY, f64::min);
        let message = format!(
            "the steps are not equal, from {} to {} s: the times are kept as they are",
            least * factor,
            step(widest) * factor
        );
        notes.push(Note::remark(message, parts.rows[widest + 1].range()));
        let times = column.iter().map(|(t, _)| t * factor).collect();
        return Ok(Times::At(times));
    }
    let decimals = (-(2.0 * written).log10()).round().clamp(0.0, 17.0) as usize;
    let middle = 0.5 * (low + high);
    let decimal = (0..=decimals)
        .filter_map(|d| format!("{middle:.d$}").parse::<f64>().ok())
        .find(|dt| *dt > 0.0 && (low..=high).contains(dt));
    let (first_rate, last_rate) = ((1.0 / high).ceil(), (1.0 / low).floor());
    let dt = match decimal {
        Some(dt) => dt * factor,
        None => {
            let (dt, shown) = if first_rate == last_rate && factor == 1.0 {
                (1.0 / first_rate, format!("1/{first_rate} s"))
            } else {
                let dt = (end - start) / last as f64 * factor;
                (dt, format!("{dt} s"))
            };
            let message = format!("the times are rounded; they have the step {shown}");
            notes.push(Note::remark(message, place));
            dt
        }
    };
    Ok(Times::Every {
        start: start * factor,
        dt,
    })
}
