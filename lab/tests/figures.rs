//! `twelvefold-lab figures`, run as a program: each picture parses and shows what its caption says.

use std::collections::{BTreeSet, HashMap};
use std::path::Path;
use std::process::{Command, Output};
use std::sync::LazyLock;

use roxmltree::{Document, Node};

fn run(folder: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_twelvefold-lab"));
    command.arg("figures").arg("-o").arg(folder).output().unwrap()
}

/// The seven documents of one run, by number.
static FIGURES: LazyLock<HashMap<usize, String>> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    // Missing folders are made.
    let target = folder.path().join("new/figures");
    let output = run(&target);
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
    let names: BTreeSet<_> = std::fs::read_dir(&target)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    let expected: BTreeSet<_> = (1..=7).map(|n| format!("fig{n}.svg")).collect();
    assert_eq!(names, expected);
    let read = |n| std::fs::read_to_string(target.join(format!("fig{n}.svg"))).unwrap();
    (1..=7).map(|n| (n, read(n))).collect()
});

fn document(number: usize) -> Document<'static> {
    Document::parse(&FIGURES[&number]).unwrap()
}

fn groups<'a>(document: &'a Document<'_>, class: &str) -> Vec<Node<'a, 'a>> {
    let of_class = |node: &Node<'_, '_>| node.attribute("class") == Some(class);
    document.descendants().filter(of_class).collect()
}

fn group<'a>(document: &'a Document<'_>, class: &str) -> Node<'a, 'a> {
    let mut found = groups(document, class);
    assert_eq!(found.len(), 1, "{class}");
    found.remove(0)
}

fn elements<'a>(group: Node<'a, 'a>, name: &str) -> Vec<Node<'a, 'a>> {
    group.children().filter(|node| node.has_tag_name(name)).collect()
}

fn number(node: &Node<'_, '_>, attribute: &str) -> f64 {
    node.attribute(attribute).unwrap().parse().unwrap()
}

/// The points of a path of M, L and z commands.
fn points(path: &Node<'_, '_>) -> Vec<[f64; 2]> {
    let text = path.attribute("d").unwrap().trim_end_matches('z');
    text.split(['M', 'L'])
        .skip(1)
        .map(|pair| {
            let (x, y) = pair.split_once(' ').unwrap();
            [x.parse().unwrap(), y.parse().unwrap()]
        })
        .collect()
}

fn centers(circles: &[Node<'_, '_>]) -> Vec<[f64; 2]> {
    circles.iter().map(|circle| [number(circle, "cx"), number(circle, "cy")]).collect()
}

/// All text below a node, subscripts included.
fn text(node: &Node<'_, '_>) -> String {
    let parts = node.descendants().filter(Node::is_text).filter_map(|node| node.text());
    parts.collect::<String>().replace('\u{200b}', "")
}

#[test]
fn all_are_small_titled_and_finite() {
    for n in 1..=7 {
        let source = &FIGURES[&n];
        assert!(source.len() < 1_000_000, "fig{n}: {} bytes", source.len());
        assert!(!source.contains("NaN") && !source.contains("inf"), "fig{n}");
        let document = document(n);
        let root = document.root_element();
        assert_eq!(root.tag_name().name(), "svg");
        for name in ["title", "desc"] {
            let element = root.children().find(|node| node.has_tag_name(name));
            assert!(element.unwrap().text().unwrap().len() > 10, "fig{n} {name}");
        }
        let (width, height) = (number(&root, "width"), number(&root, "height"));
        assert_eq!(root.attribute("viewBox").unwrap(), format!("0 0 {width} {height}"));
        assert!(width > 600.0 && width < 1200.0 && height > 250.0 && height < 1400.0);
        // Labels start, or are anchored, on the page.
        for label in document.descendants().filter(|node| node.has_tag_name("text")) {
            let (x, y) = (number(&label, "x"), number(&label, "y"));
            assert!(x > 5.0 && x < width - 5.0 && y > 10.0 && y < height - 3.0, "fig{n}");
        }
    }
}

#[test]
fn figure_1_shows_unit_edges_and_a_dual_of_pentagons_and_hexagons() {
    let document = document(1);
    let cells = elements(group(&document, "dual"), "path");
    let edges = elements(group(&document, "tiling"), "path");
    let corners: Vec<usize> = cells.iter().map(|cell| points(cell).len()).collect();
    assert!(corners.iter().all(|count| [5, 6].contains(count)));
    assert!(corners.contains(&5) && corners.contains(&6) && corners.len() > 150);
    let lengths = edges.iter().map(|edge| {
        let [a, b] = points(edge).try_into().unwrap();
        (b[0] - a[0]).hypot(b[1] - a[1])
    });
    for length in lengths {
        assert!((length - 52.0).abs() < 0.02, "{length}");
    }
    // An edge for each two star entries; the border has cells whose edges start outside.
    let per_cell = edges.len() as f64 / cells.len() as f64;
    assert!((2.3..2.7).contains(&per_cell), "{per_cell}");
}

#[test]
fn figure_2_keeps_every_coarse_center_and_shows_2000_points() {
    let document = document(2);
    let fine = centers(&elements(group(&document, "fine-centers"), "circle"));
    let coarse = centers(&elements(group(&document, "coarse-centers"), "circle"));
    assert_eq!(elements(group(&document, "fine"), "path").len(), fine.len());
    assert_eq!(elements(group(&document, "coarse"), "path").len(), coarse.len());
    // The coarse patch reaches beyond the frame by one of its own, larger edges.
    let shown =
        coarse.iter().filter(|[x, y]| (10.0..=490.0).contains(x) && (10.0..=490.0).contains(y));
    let mut count = 0;
    for [x, y] in shown {
        let stays = fine.iter().any(|[u, v]| (x - u).abs() < 0.02 && (y - v).abs() < 0.02);
        assert!(stays, "({x}, {y})");
        count += 1;
    }
    assert!(count >= 12, "{count}");
    let dots = elements(group(&document, "points"), "circle").len();
    assert!((1980..=2020).contains(&dots), "{dots}");
}

#[test]
fn figure_3_shows_the_55_entries_of_equation_1() {
    let document = document(3);
    for (parent, children) in [
        ("a", "a0 b1 b2 b3 b7 b8 b9 c4 c5 c6 cA cB cC"),
        ("b", "a0 b3 c4 c5 c6 cA cB cC d1 d2 d7 d8 d9 dD"),
        ("c", "a0 b1 b3 b8 c5 c6 c7 cB cC cD d2 d4 d9 dA"),
        ("d", "a0 b3 b9 c4 c5 c6 cA cB cC d1 d2 d7 d8 dD"),
    ] {
        let group = group(&document, &format!("rule-{parent}"));
        let labels: BTreeSet<String> = elements(group, "text").iter().map(text).collect();
        assert_eq!(labels.into_iter().collect::<Vec<_>>().join(" "), children);
        // A cell and a wedge for each child, and the parent's outline.
        let count = children.split(' ').count();
        assert_eq!(elements(group, "path").len(), 2 * count + 1);
    }
}

#[test]
fn figure_4_rises_between_powers_of_delta() {
    let document = document(4);
    let rises: Vec<Node<'_, '_>> =
        groups(&document, "psi").iter().flat_map(|group| elements(*group, "path")).collect();
    // Six on each axis: from 0.001 to 200 and from 0.01 to 10,000.
    assert_eq!(rises.len(), 12);
    for rise in &rises {
        let points = points(rise);
        assert!(points.len() > 50);
        // Upwards on the page is downwards in y.
        assert!(points.is_sorted_by(|a, b| a[0] <= b[0] && a[1] >= b[1]));
    }
}

#[test]
fn figure_5_has_dots_in_proportion_to_the_ramp() {
    let document = document(5);
    let dots = centers(&elements(group(&document, "points"), "circle"));
    assert!((6300..=6500).contains(&dots.len()), "{}", dots.len());
    // Tenths of a ramp of length 1000 that starts at 8: 1, 3, 5 … 19 hundredths of the dots.
    for tenth in 0..10 {
        let left = 8.0 + 100.0 * f64::from(tenth);
        let count = dots.iter().filter(|[x, _]| (left..left + 100.0).contains(x)).count() as f64;
        let expected = 64.0 * f64::from(2 * tenth + 1);
        assert!((count - expected).abs() < 4.0 * expected.powf(0.4), "{tenth}: {count} {expected}");
    }
}

#[test]
fn figure_6_subdivides_twice_and_zooms() {
    let document = document(6);
    for (level, tiles) in [(0, 1), (1, 13), (2, 181)] {
        let cells = elements(group(&document, &format!("level-{level}")), "path");
        assert_eq!(cells.len(), tiles);
    }
    let numbers = groups(&document, "numbers");
    let shown: Vec<f64> =
        elements(numbers[1], "text").iter().map(|number| text(number).parse().unwrap()).collect();
    // Thirteen numbers by ascending digit: k/13.
    for (k, threshold) in shown.iter().enumerate() {
        assert!((threshold - k as f64 / 13.0).abs() < 0.0006, "{shown:?}");
    }
    assert_eq!(shown.len(), 13);
    let zoomed: Vec<usize> =
        groups(&document, "zoomed").iter().map(|group| elements(*group, "path").len()).collect();
    // Subdividing multiplies by about 14, zooming divides by it.
    assert_eq!(zoomed.len(), 4);
    assert!(zoomed[1] > 5 * zoomed[0] && zoomed[3] > 5 * zoomed[2], "{zoomed:?}");
}

#[test]
fn figure_7_shows_1024_points_of_each_sequence() {
    let document = document(7);
    let panels = groups(&document, "points");
    assert_eq!(panels.len(), 3);
    let mut spacing = Vec::new();
    for panel in panels {
        let circles = elements(panel, "circle");
        assert_eq!(circles.len(), 1024);
        // Ascending thresholds: from dark violet to yellow.
        assert_eq!(circles[0].attribute("fill"), Some("#440154"));
        assert!(circles[1023].attribute("fill").unwrap().starts_with("#f"));
        let centers = centers(&circles);
        let distances = centers
            .iter()
            .enumerate()
            .flat_map(|(i, a)| centers[..i].iter().map(move |b| (a[0] - b[0]).hypot(a[1] - b[1])));
        spacing.push(distances.fold(f64::INFINITY, f64::min));
    }
    // "Our sequence offers higher level of regularity": the closest pair is farther apart.
    assert!(spacing[2] > 2.0 * spacing[0] && spacing[2] > 2.0 * spacing[1], "{spacing:?}");
}

#[test]
fn two_runs_draw_the_same_and_a_folder_that_cannot_be_is_named() {
    let folder = tempfile::tempdir().unwrap();
    assert!(run(folder.path()).status.success());
    for n in 1..=7 {
        let path = folder.path().join(format!("fig{n}.svg"));
        assert_eq!(std::fs::read_to_string(path).unwrap(), FIGURES[&n], "fig{n}");
    }
    let file = folder.path().join("fig1.svg");
    let output = run(&file);
    assert_eq!(output.status.code(), Some(1));
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(message.lines().count() == 1 && message.contains("fig1.svg"), "{message}");
    // One target that cannot be written leaves the other six as they were.
    for n in 1..=7 {
        std::fs::write(folder.path().join(format!("fig{n}.svg")), "old").unwrap();
    }
    let blocked = folder.path().join("fig5.svg");
    std::fs::remove_file(&blocked).unwrap();
    std::fs::create_dir(&blocked).unwrap();
    let output = run(folder.path());
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8(output.stderr).unwrap().contains("fig5.svg"));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 7);
    for n in [1, 2, 3, 4, 6, 7] {
        let path = folder.path().join(format!("fig{n}.svg"));
        assert_eq!(std::fs::read_to_string(path).unwrap(), "old", "fig{n}");
    }
}
