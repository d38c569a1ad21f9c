//! A field ended the large islands of hybrid mode. Its potential was booked while their members still had an account of their
//! own, which then told it a second time: the ledger was off by all of it.

use carom_dynamics::{BodyDef, Mode, RadialField, World};
use carom_math::vec2;
use carom_tests::scenes::{disc, put, surface, walled};

#[test]
fn a_field_beside_a_large_island_keeps_the_ledger() {
    let material = surface(0.0, 0.5);
    let mut world = walled(Mode::Hybrid, vec2(2.0, 4.0), material);
    for k in 0..40_u32 {
        let (row, column) = (f64::from(k / 5), f64::from(k % 5));
        let at = vec2(0.7 * column - 1.4 + 0.01 * row, 0.7 * row - 3.5);
        put(&mut world, BodyDef::dynamic().at(at), disc(0.3), material);
    }
    world.step(1.0);
    let balances = |name: &str, world: &World| {
        let book = world.energy();
        let off = book.residual().abs() / book.external.abs();
        assert!(
            off < 1e-12,
            "{name}: off by {off:e} of what came in, {book:?}"
        );
    };
    balances("before", &world);
    let field = RadialField::new(vec2(0.0, -6.0), 30.0, 1.0).expect("a planet");
    world.add_field(field);
    balances("with a field", &world);
    world.step(0.1);
    balances("a moment later", &world);
    world.clear_fields();
    balances("without", &world);
}
