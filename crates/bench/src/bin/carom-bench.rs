//! The driver of the laboratory.

fn main() {
    println!("{}", carom_bench::CASES.len());
}
