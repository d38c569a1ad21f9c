//! Drawings show what pictures show, and stand in a page with others.

use super::*;

#[test]
fn base64_as_in_its_document() {
    for (plain, packed) in [
        ("", ""),
        ("f", "Zg=="),
        ("fo", "Zm8="),
        ("foo", "Zm9v"),
        ("foobar", "Zm9vYmFy"),
    ] {
        assert_eq!(base64(plain.as_bytes()), packed);
    }
}

fn drawn(ops: &[Op]) -> String {
    write(Size::new(100, 80).unwrap(), ops, &Style::light())
}

fn wearing(centre: Vec2, face: &Face) -> Op {
    Op::Face {
        centre,
        radius: 10.0,
        turn: Rot::IDENTITY,
        face: face.clone(),
    }
}

#[test]
fn a_line_with_a_point_that_is_not_finite_keeps_its_other_points_as_in_a_picture() {
    let at = |x: f64| Vec2::new(x, 10.0);
    let line = |points: Vec<Vec2>| {
        [Op::Line {
            points,
            width: 2.0,
            dash: None,
            ink: Ink::Text,
        }]
    };
    let broken = line(vec![at(10.0), at(20.0), at(f64::NAN), at(40.0), at(50.0)]);
    let svg = drawn(&broken);
    assert!(
        svg.contains(r#"d="M10.00 10.00L20.00 10.00M40.00 10.00L50.00 10.00""#),
        "{svg}"
    );
    let mut frame = crate::Frame::new(Size::new(100, 80).unwrap());
    for op in broken {
        frame.push(op);
    }
    let picture = frame.paint(&Style::light());
    let inked = |x| picture.pixel(x, 10) != Some(Style::light().background);
    assert_eq!([15, 30, 45].map(inked), [true, false, true]);
    // Nothing of it is left.
    assert_eq!(drawn(&line(vec![at(10.0), at(f64::INFINITY)])), drawn(&[]));
    let closed = drawn(&line(vec![at(1.0), at(2.0), Vec2::new(2.0, 5.0), at(1.0)]));
    assert!(
        closed.contains(r#"d="M2.00 10.00L2.00 5.00L1.00 10.00Z""#),
        "{closed}"
    );
}

#[test]
fn a_box_turned_inside_out_is_empty_as_in_a_picture() {
    let bounds = |min: f64, max: f64| Op::Box {
        min: Vec2::splat(min),
        max: Vec2::splat(max),
        fill: Some(Ink::Text),
        border: None,
        width: 1.0,
        dash: None,
    };
    assert_eq!(drawn(&[bounds(20.0, 10.0)]), drawn(&[]));
    assert!(drawn(&[bounds(10.0, 20.0)]).contains("<path"));
}

#[test]
fn a_face_is_written_once_for_all_discs() {
    let face = Face::smile();
    let discs = [10.0, 40.0, 70.0].map(|x| wearing(Vec2::new(x, 20.0), &face));
    let svg = drawn(&discs);
    assert_eq!(svg.matches("data:image/png").count(), 1);
    assert_eq!(svg.matches("<use href=").count(), 3);
    let one = drawn(&discs[..1]);
    assert!(
        svg.len() < one.len() + 1000,
        "{} and {}",
        svg.len(),
        one.len()
    );
}

#[test]
fn names_of_two_drawings_in_one_page_differ() {
    let face = Face::smile();
    let names = |x: f64| -> Vec<String> {
        let svg = drawn(&[wearing(Vec2::new(x, 20.0), &face)]);
        assert!(!svg.contains(NAME));
        let parts = svg.split(r#"id=""#).skip(1);
        let names = parts.map(|part| part.split('"').next().unwrap().to_owned());
        let names: Vec<_> = names.collect();
        for name in &names {
            assert!(svg.contains(&format!("#{name}")), "{name} is not used");
        }
        names
    };
    let (a, b) = (names(10.0), names(11.0));
    assert_eq!((a.len(), b.len()), (2, 2));
    assert!(a.iter().all(|name| !b.contains(name)), "{a:?} {b:?}");
}

#[test]
fn markup_in_a_label_is_text() {
    let at = Vec2::new(10.0, 10.0);
    let label = Label::new(at, "a < \"b\" & c\u{7}", 10.0, Ink::Text);
    let svg = write(
        Size::new(100, 20).unwrap(),
        &[label.into()],
        &Style::light(),
    );
    assert!(
        svg.contains(r#"aria-label="a &lt; &quot;b&quot; &amp; c ""#),
        "{svg}"
    );
}
