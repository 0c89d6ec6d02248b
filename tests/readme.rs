//! What the README says is what the program does.

#[allow(dead_code)] // `main` prints the table
#[path = "../examples/walk.rs"]
mod walk;

#[test]
fn the_table_of_the_walk_is_the_computed_one() {
    let readme = include_str!("../README.md");
    for row in walk::table().lines() {
        assert!(
            readme.contains(row),
            "README.md lacks the row\n{row}\nrun `cargo run --release --example walk`"
        );
    }
}
