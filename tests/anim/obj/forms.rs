//! The same content in different forms: the reader has a short way for the usual ones.

use super::{import, model};
use dragonfly_kit::random::{Random, seed};
use glam::Vec3;

/// A random model of which each line is one of several forms of the same statement.
fn text(random: &mut Random) -> Vec<String> {
    let mut lines = Vec::new();
    let (mut counts, materials) = ([0_usize; 3], ["red", "blue"]);
    for _ in 0..200 {
        let mut number = || match random.below(6) {
            0 => format!("{}", random.between(-9.0, 9.0)),
            1 => format!("{}", random.below(100)),
            2 => format!("-{}.", random.below(100)),
            3 => format!(".{:03}", random.below(1000)),
            4 => format!("+{:.12}", random.between(0.0, 1.0)),
            _ => format!("{:e}", random.between(-1.0, 1.0)),
        };
        let numbers = [number(), number(), number()];
        match random.below(8) {
            0 | 1 => {
                counts[0] += 1;
                lines.push(format!("v {}", numbers.join(" ")));
            }
            2 => {
                counts[1] += 1;
                lines.push(format!("vt {}", numbers[random.below(3)..].join(" ")));
            }
            3 => {
                counts[2] += 1;
                lines.push(format!("vn {}", numbers.join("  ")));
            }
            4 => lines.push(format!("s {}", random.below(3))),
            5 => lines.push(format!(
                "{} {}",
                ["o", "g", "usemtl"][random.below(3)],
                materials[random.below(2)]
            )),
            _ if counts[0] > 2 => {
                let mut line = "f".to_owned();
                for _ in 0..3 + random.below(3) {
                    let [v, t, n] = counts.map(|count| {
                        let index = 1 + random.below(count.max(1));
                        if random.below(9) > 0 {
                            index as i64
                        } else {
                            index as i64 - count.max(1) as i64 - 1
                        }
                    });
                    let form = random.below(4);
                    line += &match (form, counts[1] > 0, counts[2] > 0) {
                        (1, true, _) => format!(" {v}/{t}"),
                        (2, _, true) => format!(" {v}//{n}"),
                        (3, true, true) => format!(" {v}/{t}/{n}"),
                        _ => format!(" {v}"),
                    };
                }
                lines.push(line);
            }
            _ => {}
        }
    }
    lines
}

#[test]
fn comments_blanks_and_line_ends_do_not_change_a_model() {
    let seed = seed(41);
    let mut random = Random::new(seed);
    let mut triangles = 0;
    for round in 0..60 {
        let lines = text(&mut random);
        let plain = import(lines.join("\n")).unwrap();
        triangles += plain.model.meshes.iter().flat_map(|mesh| &mesh.primitives).count();
        let forms = [
            lines.join("\r\n") + "\r\n",
            lines.join(" # a comment\n") + " # the last one",
            format!("\n  {}\n", lines.join("\t\n\n\t")),
            lines.iter().map(|line| line.replace(' ', "\t ") + "\n").collect(),
            // A line with a backslash is not one of the usual form.
            lines.iter().map(|line| line.replacen(' ', " \\\n", 1) + "\r").collect(),
        ];
        for (form, text) in forms.iter().enumerate() {
            let other = import(text).unwrap();
            assert_eq!(other.model, plain.model, "seed {seed}, round {round}, form {form}");
            assert_eq!(other.warnings.len(), plain.warnings.len(), "seed {seed}, round {round}, form {form}");
        }
    }
    assert!(triangles > 100, "{triangles}");
}

#[test]
fn values_that_are_almost_of_the_usual_form_are_the_same_errors_as_ever() {
    for (line, error) in [
        ("v 1 2", "line 4 column 1: 2 values for a position, at least 3 are needed"),
        ("v 1 2 3x", "line 4 column 7: \"3x\" is no number where a position was expected"),
        ("vn 1 2 3/4", "line 4 column 8: \"3/4\" is no number where a normal was expected"),
        ("f 1/ 2 3 4", "line 4 column 1: there is no vertex 4, the file has 3"),
        ("f 1 2 0", "line 4 column 7: \"0\" refers to nothing in the file"),
        ("f 1 2 3/1/1/1", "line 4 column 7: \"3/1/1/1\" where a corner such as 1/2/3 was expected"),
        ("f 1 2 123456789", "line 4 column 7: \"123456789\" refers to nothing in the file"),
    ] {
        let found = import(format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{line}")).unwrap_err();
        assert_eq!(found.to_string(), error, "{line}");
    }
}

#[test]
fn corners_share_vertices_also_where_many_have_one_position() {
    let mut text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n".to_owned();
    for normal in 0..40 {
        text += &format!("vn {normal} 0 1\n");
    }
    // Each fan twice, in two orders.
    for normal in (1..=40).chain((1..=40).rev()) {
        text += &format!("f 1//{normal} 2//{normal} 3//{normal}\n");
    }
    let primitive = &model(&text).meshes[0].primitives[0];
    assert_eq!(primitive.vertices.positions.len(), 120);
    let (first, second) = primitive.indices.split_at(120);
    assert_eq!(first, (0..120).collect::<Vec<u32>>());
    assert!(second.chunks_exact(3).eq(first.chunks_exact(3).rev()));
    assert_eq!(primitive.vertices.normals[0], Vec3::Z);
}
