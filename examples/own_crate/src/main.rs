//! Prints the motion every quarter of a second.

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!(
        "{:>6} {:>8} {:>10} {:>8}",
        "t / s", "x / m", "phi / rad", "F / N"
    );
    let mut tick = 0;
    let last = own_crate::control(&own_crate::tilted()?, |t, [x, _, phi, _], force| {
        if tick % 25 == 0 {
            println!("{t:6.2} {x:8.4} {phi:10.6} {force:8.3}");
        }
        tick += 1;
    })?;
    println!("at the end {:.1e} rad from upright", last[2].abs());
    Ok(())
}
