//! Pair algorithms and geometry side by side: carom against parry2d in `f64`.
//!
//! Both get the same random shapes, poses and motions, parry through its any-shape entry, and take turns
//! in going first. A row is the median CPU time of its rounds for one question, and the number of wrong
//! answers of each, checked by brute force or by whole numbers.

mod exact;
mod flights;
mod geometry;
mod meetings;
#[path = "../../../../../tests/it/twins/naive.rs"]
mod naive;
mod race;
mod shapes;

use race::Table;

fn main() {
    let table = Table::new();
    meetings::manifolds(&table);
    meetings::distances(&table);
    flights::impacts(&table);
    geometry::mass(&table);
    geometry::hulls(&table);
    geometry::pieces(&table);
}
