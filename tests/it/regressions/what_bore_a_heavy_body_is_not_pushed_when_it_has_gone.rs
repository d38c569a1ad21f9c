//! A disc of 417 t rolls over a box of 0.7 kg that lies on the floor. In closed form the floor bears it with 8000 N s in each
//! sub-step; when the group came to its end and the disc had no row, the solver began with these impulses all the same, and
//! threw the box out of its walls by 38 of its sizes.

use carom_dynamics::{BodyDef, Mode};
use carom_geometry::{ConvexPolygon, Polygon, Shape};
use carom_math::{Vec2, vec2};
use carom_tests::scenes::{block, disc, outside, put, surface, walled};

const HALF: Vec2 = vec2(2.9158362195131833, 3.673084749159281);

fn regular(sides: usize, radius: f64) -> Shape {
    ConvexPolygon::regular(sides, radius)
        .expect("a polygon")
        .into()
}

/// An L of two legs.
fn angle(width: f64, height: f64, thick: f64) -> Shape {
    let corners = [
        vec2(0.0, 0.0),
        vec2(width, 0.0),
        vec2(width, thick),
        vec2(thick, thick),
        vec2(thick, height),
        vec2(0.0, height),
    ];
    Polygon::new(corners.to_vec()).expect("an L").into()
}

#[test]
fn what_bore_a_heavy_body_is_not_pushed_when_it_has_gone() {
    let material = surface(0.3, 0.5);
    let mut world = walled(Mode::Hybrid, HALF, material);
    // Found by chance: shape, origin, angle, velocity, spin, mass.
    let bodies: [(Shape, Vec2, f64, Vec2, f64, f64); 12] = [
        (
            regular(4, 0.5224862425824279),
            vec2(-0.7534723100880849, 2.2915054736104006),
            -0.20787693324770373,
            vec2(4.816916300354183, 4.7471886636648435),
            18.350692268646753,
            0.00043428923832602214,
        ),
        (
            disc(0.22506571105602158).into(),
            vec2(-0.36056982844501206, -1.7135173502676917),
            -1.4346013233539197,
            vec2(4.371281254649764, 2.1370986354990054),
            79.89902609340697,
            0.03537917960208967,
        ),
        (
            block(0.5638103162682075, 0.2091490232966203).into(),
            vec2(1.996681317433505, 2.7180709435227772),
            -3.091785819909398,
            vec2(1.7129161556760595, 4.040783637030215),
            -3.4624782618207917,
            0.00023957901382516052,
        ),
        (
            disc(0.11983077076477534).into(),
            vec2(-0.3983490089304551, 1.36175958282334),
            -2.4238409900852105,
            vec2(-3.071053582913877, 4.083444277987663),
            -14.30280594259088,
            417422.8738782049,
        ),
        (
            block(0.7783417568936974, 0.7652761659565913).into(),
            vec2(0.4916581541251146, -3.043369010871656),
            -2.9498127899210185,
            vec2(0.863203000402267, -3.947826880131964),
            -3.237104572798317,
            0.7223778622715081,
        ),
        (
            regular(6, 0.4311552189721802),
            vec2(-1.3820203942978944, -2.708624335006678),
            2.8883854563471063,
            vec2(2.079753367654771, -1.4715552229713658),
            -53.25119703858104,
            0.0005701937930521942,
        ),
        (
            regular(3, 0.4698677590980718),
            vec2(1.1222128559365778, 2.7816112030439784),
            0.0,
            vec2(-0.4733888559804651, -4.311883596869295),
            0.0,
            19278.71750231971,
        ),
        (
            angle(0.37715123692713093, 0.5314340485164669, 0.06015579006068053),
            vec2(1.5027264098050965, -1.3442813217416354),
            0.0,
            vec2(1.6084263595908732, -2.570156935104287),
            0.0,
            0.12272080317726292,
        ),
        (
            block(0.2601205669479935, 0.08304150691483064).into(),
            vec2(0.4599935596340119, 1.9128988201394361),
            -2.3541008965427226,
            vec2(0.38806771354694103, 2.1846985919404442),
            4.552300870051695,
            4.553323922213435e-6,
        ),
        (
            block(0.4831773738021826, 0.30670987948939515).into(),
            vec2(-0.7520900534077319, 0.7690844810127206),
            -1.591866366225088,
            vec2(-0.8393433169822329, -1.236990475673215),
            -0.15524413961754302,
            0.05095563359763766,
        ),
        (
            regular(4, 0.28344698154491144),
            vec2(-1.2743686264436607, -0.11139671120542483),
            -1.5199121237143935,
            vec2(0.4242864316170145, 3.958117688004494),
            125.71466635281092,
            0.08939466911370154,
        ),
        (
            angle(0.375229348505842, 0.3336341686614323, 0.04765322860751701),
            vec2(1.09443215381974, -0.08001522651030202),
            3.02362009457483,
            vec2(-4.0031343938338395, -1.1316946748197623),
            3.5009261127740317,
            0.03660836598321771,
        ),
    ];
    for (shape, at, angle, velocity, spin, mass) in bodies {
        let body = BodyDef::dynamic().at(at).turned(angle).moving(velocity);
        put(
            &mut world,
            body.spinning(spin).with_mass(mass),
            shape,
            material,
        );
    }
    for _ in 0..130 {
        world.step(1.0 / 60.0);
        let deep = outside(&world, HALF);
        assert!(deep < 5e-3, "{deep} m outside, {:?}", world.time());
    }
}
