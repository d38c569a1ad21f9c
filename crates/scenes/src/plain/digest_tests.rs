//! Every scene holds the bits that the peers were measured with.

use super::{plain_scene, plain_scenes};

/// Digests of the data that the scenes were published as, taken with `examples/check_scenes.rs`.
const PUBLISHED: [(&str, u64); 14] = [
    ("a_large_pyramid", 0xd12b_8a6d_d169_0975),
    ("b_many_pyramids", 0x2552_5cd1_da19_a7e0),
    ("c_smash", 0x02f5_5d96_4c2e_0c61),
    ("d_tumbler", 0x3131_4315_2ba0_5d86),
    ("e_flying_polygons", 0xe9b8_e978_1a9b_6e6d),
    ("e_medium", 0x9858_b720_3ada_c331),
    ("e_dilute", 0xe435_65cd_bee7_b8d1),
    ("f_polygon_pile", 0x9114_ff08_eb6b_9728),
    ("g_concave_pile", 0xb142_00cb_48a7_7351),
    ("h_mostly_sleeping", 0x8191_aad0_524e_ac8c),
    ("i_mostly_empty", 0xba71_312c_8ad3_26af),
    ("case12_polygon_gas", 0x3221_f1cf_0904_371c),
    ("case18_disc_gas", 0x0ade_7b47_14f7_14a1),
    ("case19_polygon_pairs", 0x0576_f682_9cc5_378c),
];

#[test]
fn every_bit_is_as_published() {
    for (name, digest) in PUBLISHED {
        let scene = plain_scene(name).unwrap_or_else(|| panic!("no scene {name}"));
        assert_eq!(scene.digest(), digest, "{name}: {:#018x}", scene.digest());
    }
    assert_eq!(PUBLISHED.len(), plain_scenes().len());
}

#[test]
fn a_letter_names_a_scene() {
    for (letter, name) in [
        ("a", "a_large_pyramid"),
        ("e", "e_flying_polygons"),
        ("i", "i_mostly_empty"),
    ] {
        assert_eq!(
            plain_scene(letter).map(|scene| scene.name),
            Some(name.to_owned())
        );
    }
    assert!(plain_scene("").is_none() && plain_scene("large_pyramid").is_none());
}
