//! Numbers as Fortran writes them, apart or touching, free or in columns.

use super::Fault;
use super::text::{Line, Page};

/// A number at the start of a text, and the length of its text. `None` if there is none.
///
/// An exponent may have `D` for `E`, and none of both if it has three digits: `1.234-103`.
fn leading(text: &str) -> Option<(f64, usize)> {
    let bytes = text.as_bytes();
    let digits = |from: usize| {
        bytes[from..]
            .iter()
            .take_while(|b| b.is_ascii_digit())
            .count()
    };
    let is_sign = |at: usize| matches!(bytes.get(at), Some(b'+' | b'-'));
    let sign = usize::from(is_sign(0));
    let whole = digits(sign);
    let mut end = sign + whole;
    let point = bytes.get(end) == Some(&b'.');
    let mut fraction = 0;
    if point {
        fraction = digits(end + 1);
        end += 1 + fraction;
    }
    if whole + fraction == 0 {
        return None;
    }
    let mantissa = &text[..end];
    let mut exponent = "0";
    if matches!(bytes.get(end), Some(b'e' | b'E' | b'd' | b'D')) {
        let from = end + 1;
        let length = usize::from(is_sign(from));
        let count = digits(from + length);
        if count == 0 {
            return None;
        }
        end = from + length + count;
        exponent = &text[from..end];
    } else if point && is_sign(end) && digits(end + 1) == 3 {
        let after = end + 4;
        if !matches!(bytes.get(after), Some(b'.' | b'e' | b'E' | b'd' | b'D')) {
            exponent = &text[end..after];
            end = after;
        }
    }
    let number: f64 = format!("{mantissa}e{exponent}").parse().ok()?;
    // What underflows is not the number that is written.
    let lost = number == 0.0 && mantissa.bytes().any(|b| (b'1'..=b'9').contains(&b));
    Some((if lost { f64::NAN } else { number }, end))
}

/// The number that a text is; blanks around it do not count.
pub(super) fn number(text: &str) -> Option<f64> {
    let text = text.trim();
    match leading(text) {
        Some((number, end)) if end == text.len() && number.is_finite() => Some(number),
        _ => None,
    }
}

/// The number at the start of a text, and the rest of the text.
pub(super) fn first_number(text: &str) -> Option<(f64, &str)> {
    let (number, end) = leading(text.trim_start())?;
    number
        .is_finite()
        .then(|| (number, &text.trim_start()[end..]))
}

/// A count: digits alone.
pub(super) fn count(text: &str) -> Option<usize> {
    let text = text.trim();
    let digits = !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    digits.then(|| text.parse().ok()).flatten()
}

/// How exactly a number is written: half a unit of its last digit.
pub(super) fn rounding(text: &str) -> f64 {
    let text = text.trim();
    let end = text.find(['e', 'E', 'd', 'D']).unwrap_or(text.len());
    let exponent: i32 = text[end..]
        .get(1..)
        .and_then(|e| e.trim_start_matches('+').parse().ok())
        .unwrap_or(0);
    let decimals = text[..end].find('.').map_or(0, |point| end - point - 1);
    0.5 * 10f64.powi(exponent.saturating_sub(decimals as i32))
}

fn not_a_number(line: &Line, token: &str) -> Fault {
    let lower = token.to_ascii_lowercase();
    let help = if lower.contains("nan")
        || lower.contains("inf")
        || leading(token).is_some_and(|(x, n)| n == token.len() && !x.is_finite())
    {
        "every value must be finite in double precision"
    } else if token.contains('*') {
        "stars are where a number did not fit its column; get the record anew"
    } else if token.contains(',') {
        "write decimals with a point"
    } else {
        "numbers may touch only where a sign separates them, or in the columns of the format"
    };
    Fault::new(
        format!("`{token}` is not a finite number"),
        line.place(token),
        help,
    )
}

/// The numbers of a line, separated by blanks or by the sign of the next.
pub(super) fn free(line: &Line, numbers: &mut Vec<f64>) -> Result<(), Fault> {
    for token in line.text.split_whitespace() {
        let mut rest = token;
        while !rest.is_empty() {
            match leading(rest) {
                Some((number, end)) if number.is_finite() => {
                    let next = rest[end..].bytes().next();
                    if !matches!(next, None | Some(b'+' | b'-')) {
                        return Err(not_a_number(line, token));
                    }
                    numbers.push(number);
                    rest = &rest[end..];
                }
                _ => return Err(not_a_number(line, token)),
            }
        }
    }
    Ok(())
}

/// Columns of equal width, as a Fortran format says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Columns {
    pub count: usize,
    /// Bytes.
    pub width: usize,
}

impl Columns {
    /// Reads formats such as `(8F10.5)`, `(1E15.6)`, `10I8` and `8(1PE10.4E1)`.
    pub fn parse(format: &str) -> Option<Columns> {
        let plain: String = format
            .chars()
            .filter(|c| !c.is_whitespace() && !"()".contains(*c))
            .collect::<String>()
            .to_ascii_uppercase();
        let letter = plain.find(|c: char| "EFDGI".contains(c))?;
        let count = match plain[..letter].strip_suffix("1P") {
            Some(count) => count.trim_end_matches(','),
            None => &plain[..letter],
        };
        let count = if count.is_empty() {
            1
        } else {
            count.parse().ok()?
        };
        let width = &plain[letter + 1..];
        let end = width
            .find(|c: char| !c.is_ascii_digit())
            .unwrap_or(width.len());
        let width = width[..end].parse().ok()?;
        (count > 0 && width > 0).then_some(Columns { count, width })
    }

    /// The numbers of `count` columns of a line, which must hold nothing else.
    fn of_line(self, line: &Line, count: usize, numbers: &mut Vec<f64>) -> Result<(), Fault> {
        let before = numbers.len();
        let help = format!(
            "the format has {} columns of width {}",
            self.count, self.width
        );
        let text = line.text.trim_end();
        for i in 0..count {
            let field = text.get(i * self.width..(i + 1) * self.width);
            let Some(field) = field else {
                let rest = text.get(i * self.width..).unwrap_or("").trim();
                let place = if rest.is_empty() {
                    line.range()
                } else {
                    line.place(rest)
                };
                let message = format!("the line ends within column {} of {count}", i + 1);
                return Err(Fault::new(message, place, help));
            };
            let shown = if field.trim().is_empty() {
                field
            } else {
                field.trim()
            };
            numbers.push(number(field).ok_or_else(|| {
                let message = format!("`{shown}` is not a finite number");
                Fault::new(message, line.place(shown), &help)
            })?);
        }
        let rest = text.get(count * self.width..).unwrap_or("").trim();
        if !rest.is_empty() {
            let message = format!("a column too many: {count} are expected in this line");
            return Err(Fault::new(message, line.place(rest), help));
        }
        // Where blanks or signs separate the numbers, they must say the same.
        let mut freely = Vec::new();
        if free(line, &mut freely).is_ok() && freely[..] != numbers[before..] {
            let message = "the numbers are not in the columns of the format";
            return Err(Fault::new(message, line.range(), help));
        }
        Ok(())
    }

    /// `wanted` numbers from line `first` on, and the number of the line after them. What is counted
    /// is for faults.
    pub fn block(
        self,
        page: &Page,
        first: usize,
        wanted: usize,
        counted: &str,
    ) -> Result<(Vec<f64>, usize), Fault> {
        let mut numbers = Vec::new();
        let mut at = first;
        while numbers.len() < wanted {
            let line = page.line(at);
            let missing = |found: usize| {
                let place = if line.is_blank() {
                    page.end()
                } else {
                    line.range()
                };
                Fault::new(
                    format!("the header counts {wanted} {counted}, {found} are there"),
                    place,
                    "the file is cut or its header is wrong; get the record anew",
                )
            };
            if at >= page.lines.len() || is_prose(&line) {
                return Err(missing(numbers.len()));
            }
            let here = (wanted - numbers.len()).min(self.count);
            let before = numbers.len();
            if let Err(fault) = self.of_line(&line, here, &mut numbers) {
                // A cut file is a matter of its count, not of its last number.
                let last = page.lines[at + 1..].iter().all(Line::is_blank);
                let cut = last && line.text.trim_end().len() < here * self.width;
                return Err(if cut { missing(before) } else { fault });
            }
            at += 1;
        }
        Ok((numbers, at))
    }
}

/// Whether a line is no row of numbers, not even of wrong ones.
fn is_prose(line: &Line) -> bool {
    let is_word = |token: &&str| {
        let lower = token.to_ascii_lowercase();
        let number = lower.contains("nan") || lower.contains("inf");
        !number && token.len() > 1 && token.bytes().all(|b| b.is_ascii_alphabetic())
    };
    line.is_blank()
        || line.text.starts_with(['/', '|'])
        || line.text.split_whitespace().filter(is_word).count() > 1
}

/// Where a line of numbers begins that nobody announced.
pub(super) fn too_many(line: &Line, wanted: usize, found: usize) -> Fault {
    Fault::new(
        format!("the header counts {wanted} values, {found} are there"),
        line.range(),
        "the header or the values are of another record; get the record anew",
    )
}
