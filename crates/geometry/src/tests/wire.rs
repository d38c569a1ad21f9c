//! What is written and read again: the feature `serde`.

use carom_math::{Pose, vec2};

use crate::{Circle, Compound, ConvexPolygon, HalfPlane, Polygon, Region, Segment, Shape};

#[test]
fn a_shape_comes_back_bit_by_bit() {
    let dented = [
        vec2(0.0, 0.0),
        vec2(2.0, 0.0),
        vec2(0.3, 0.1),
        vec2(0.0, 2.0),
    ];
    let disc = Shape::from(Circle::at(vec2(0.1, 0.2), 0.3).unwrap());
    let square = Shape::from(ConvexPolygon::square(1.0).unwrap());
    let shapes = [
        disc.clone(),
        Segment::new(vec2(0.1, 0.2), vec2(3.0, 4.0)).unwrap().into(),
        HalfPlane::new(vec2(0.1, 0.2), vec2(0.3, 0.7))
            .unwrap()
            .into(),
        ConvexPolygon::regular(7, 0.7).unwrap().into(),
        Polygon::new(dented).unwrap().into(),
        Compound::new([(disc, Pose::IDENTITY), (square, Pose::at(vec2(0.4, 0.0)))])
            .unwrap()
            .into(),
    ];
    for shape in shapes {
        let text = serde_json::to_string(&shape).unwrap();
        assert_eq!(
            serde_json::from_str::<Shape>(&text).unwrap(),
            shape,
            "{text}"
        );
    }
    let ring = |side| ConvexPolygon::square(side).unwrap().vertices().to_vec();
    let frame = Region::new(ring(4.0), [ring(2.0)]).unwrap();
    let text = serde_json::to_string(&frame).unwrap();
    assert_eq!(
        serde_json::from_str::<Region>(&text).unwrap(),
        frame,
        "{text}"
    );
}

#[test]
fn what_no_constructor_makes_is_refused_by_its_error() {
    for (text, part) in [
        (r#"{"circle": {"radius": -1.0}}"#, "radius"),
        (
            r#"{"circle": {"radius": 1.0, "colour": 3}}"#,
            "unknown field `colour`",
        ),
        (
            r#"{"segment": {"a": [1.0, 1.0], "b": [1.0, 1.0]}}"#,
            "length",
        ),
        (
            r#"{"half_plane": {"point": [0.0, 0.0], "normal": [0.0, 0.0]}}"#,
            "points nowhere",
        ),
        (
            r#"{"polygon": [[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]]}"#,
            "edge 0 meets edge 2",
        ),
        (
            r#"{"convex": [[0.0, 0.0], [2.0, 0.0], [0.3, 0.1], [0.0, 2.0]]}"#,
            "convex",
        ),
        (r#"{"compound": []}"#, "no parts"),
        (r#"{"ellipse": [1.0, 2.0]}"#, "unknown variant `ellipse`"),
    ] {
        let error = serde_json::from_str::<Shape>(text).unwrap_err().to_string();
        assert!(error.contains(part), "{error}");
    }
    assert!(serde_json::from_str::<Region>("[]").is_err());
}
