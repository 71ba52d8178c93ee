//! The library's files import downwards only: no circle among them, and no arrow up the floors below.
//! `ARCHITECTURE.md` draws the same floors.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::fs;
use std::path::Path;

/// The modules of `src/lib.rs` from the ground up. A module imports from itself and from rows below its
/// own, not from its neighbors in a row.
const FLOORS: [&[&str]; 11] = [
    &["tiling", "domain", "random", "simd", "threads"],
    &["bake", "error", "position"],
    &["tables", "importance"],
    &["tree"],
    &["placement"],
    &["sampling"],
    &["walk"],
    &["emit"],
    &["estimate", "refine", "export", "mesh", "mosaic"],
    &["light"],
    &["lib"],
];

#[test]
fn files_import_from_lower_floors_only_and_in_no_circle() {
    let mut files = Vec::new();
    read_folder(Path::new(env!("CARGO_MANIFEST_DIR")), "src", &mut files);
    let house = House::new(&files);
    assert!(house.arrows.len() > 100, "only {} imports found in src", house.arrows.len());
    let faults = house.faults();
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

#[test]
fn an_arrow_up_and_a_circle_are_found_and_named() {
    let files = |sources: &[(&str, &str)]| {
        let files = sources.iter().map(|(name, source)| (format!("src/{name}"), (*source).into()));
        House::new(&files.collect::<Vec<_>>()).faults()
    };
    let lib = ("lib.rs", "mod tiling; mod walk; pub use walk::Walk;");

    // Comments, strings, lifetimes, visibilities and tests are no imports.
    let quiet = "//! [`Walk`](crate::walk)\n/* /* */ crate::walk::x */ const S: &'static str = \
                 r#\"crate::walk::x\"#; pub(in crate::walk) const C: char = '\"'; \
                 #[cfg(test)]\nmod tests { use crate::walk::Walk; }";
    assert_eq!(
        files(&[lib, ("tiling.rs", quiet), ("walk.rs", "use crate::tiling::S; struct Walk;")]),
        [""; 0]
    );

    // Whether the way is a nested list, a re-export or a path inside an expression.
    for up in [
        "\nuse crate::{walk::{self as w, Walk}};",
        "\nuse crate::Walk;",
        "\nfn f() { crate::walk::g(); }",
        "\nfn f() { super::Walk::new(); }",
    ] {
        let faults = files(&[lib, ("tiling.rs", up), ("walk.rs", "struct Walk;")]);
        assert_eq!(faults[0], "goes up: src/tiling.rs:2 imports src/walk.rs", "{up}");
    }

    let faults = files(&[
        ("lib.rs", "mod walk;"),
        ("walk/mod.rs", "mod a; mod b; mod c; pub use c::C; const N: u8 = 1; use a::A;"),
        ("walk/a.rs", "use super::b::B;"),
        ("walk/b.rs", "use super::C;"),
        ("walk/c.rs", "\n\nuse super::N;"),
    ]);
    assert_eq!(
        faults,
        [
            "circle: src/walk/mod.rs:1 → src/walk/a.rs:1 → src/walk/b.rs:1 → src/walk/c.rs:3 → src/walk/mod.rs"
        ]
    );

    let faults = files(&[("lib.rs", "mod cellar;"), ("cellar.rs", "")]);
    assert_eq!(faults, ["src/cellar.rs is on none of the FLOORS"]);
}

/// A module's path: `walk::mode` is `["walk", "mode"]`, `lib.rs` is empty.
type Module = Vec<String>;

/// Every source file below `folder`: its path from `root` on, and its text.
fn read_folder(root: &Path, folder: &str, files: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(root.join(folder)).expect("a folder of src") {
        let entry = entry.expect("an entry of src");
        let name = format!("{folder}/{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() {
            read_folder(root, &name, files);
        } else if name.ends_with(".rs") {
            files.push((name, fs::read_to_string(entry.path()).expect("a source file")));
        }
    }
}

/// The module that a file such as `src/walk/mode.rs` or `src/walk/mod.rs` holds.
fn module_of(file: &str) -> Module {
    let parts = file.trim_end_matches(".rs").split('/').skip(1);
    parts.filter(|part| !matches!(*part, "mod" | "lib")).map(str::to_owned).collect()
}

/// One import: `from` names `to` in line `line`.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Arrow {
    from: Module,
    to: Module,
    line: usize,
}

struct House {
    /// The file of each module.
    files: BTreeMap<Module, String>,
    arrows: Vec<Arrow>,
}

impl House {
    /// From paths and texts of files.
    fn new(files: &[(String, String)]) -> Self {
        let files = files.iter().map(|(file, source)| (module_of(file), (file, Scan::new(source))));
        let (mut names, mut scanned) = (BTreeMap::new(), BTreeMap::new());
        for (module, (file, scan)) in files {
            names.insert(module.clone(), file.clone());
            scanned.insert(module, scan);
        }
        // What only tests compile is no part of the house.
        let tests: Vec<Module> = scanned
            .iter()
            .flat_map(|(module, scan)| scan.test_modules.iter().map(|name| child(module, name)))
            .collect();
        scanned.retain(|module, _| !tests.iter().any(|test| module.starts_with(test)));

        let mut arrows = BTreeSet::new();
        for (from, scan) in &scanned {
            // lib.rs only declares and re-exports.
            if from.is_empty() {
                continue;
            }
            for path in scan.paths.iter().filter(|path| !path.re_export) {
                if let Some(start) = absolute(from, &path.names, &scan.children) {
                    let to = resolve(&start, &scanned, 0);
                    if to != *from {
                        arrows.insert(Arrow { from: from.clone(), to, line: path.line });
                    }
                }
            }
        }
        for (module, scan) in &scanned {
            let (file, line) = (&names[module], scan.inner_module);
            assert!(line.is_none(), "{file}: the module in line {line:?} is not followed");
        }
        names.retain(|module, _| scanned.contains_key(module));
        Self { files: names, arrows: arrows.into_iter().collect() }
    }

    fn faults(&self) -> Vec<String> {
        let mut faults = Vec::new();
        for (module, file) in &self.files {
            if floor(module).is_none() {
                faults.push(format!("{file} is on none of the FLOORS"));
            }
        }
        for Arrow { from, to, line } in &self.arrows {
            let same = from.first() == to.first();
            if !same && floor(from).zip(floor(to)).is_some_and(|(from, to)| from <= to) {
                let (from, to) = (&self.files[from], &self.files[to]);
                faults.push(format!("goes up: {from}:{line} imports {to}"));
            }
        }
        if let Some(circle) = self.circle() {
            let mut text = String::from("circle: ");
            for arrow in &circle {
                text += &format!("{}:{} → ", self.files[&arrow.from], arrow.line);
            }
            faults.push(text + &self.files[&circle[0].from]);
        }
        faults
    }

    /// A shortest way from a file back to itself, if there is one.
    fn circle(&self) -> Option<Vec<&Arrow>> {
        let ways = self.files.keys().filter_map(|start| self.way_back(start));
        ways.min_by_key(Vec::len)
    }

    fn way_back(&self, start: &Module) -> Option<Vec<&Arrow>> {
        // Breadth first: for each file, the arrow by which it was reached.
        let mut reached_by: BTreeMap<&Module, &Arrow> = BTreeMap::new();
        let mut queue = VecDeque::from([start]);
        while let Some(here) = queue.pop_front() {
            for arrow in self.arrows.iter().filter(|arrow| arrow.from == *here) {
                if !reached_by.contains_key(&arrow.to) {
                    reached_by.insert(&arrow.to, arrow);
                    queue.push_back(&arrow.to);
                }
            }
        }
        let mut way = vec![*reached_by.get(start)?];
        while way[way.len() - 1].from != *start {
            way.push(reached_by[&way[way.len() - 1].from]);
        }
        way.reverse();
        Some(way)
    }
}

fn floor(module: &Module) -> Option<usize> {
    let room = module.first().map_or("lib", String::as_str);
    FLOORS.iter().position(|rooms| rooms.contains(&room))
}

fn child(module: &Module, name: &str) -> Module {
    let mut path = module.clone();
    path.push(name.to_owned());
    path
}

/// The path from the crate's root, or `None` where it leads out of the crate.
fn absolute(from: &Module, names: &[String], children: &BTreeSet<String>) -> Option<Module> {
    let mut base = from.clone();
    let mut rest = names;
    match rest.first()?.as_str() {
        "crate" => {
            base.clear();
            rest = &rest[1..];
        }
        "self" => rest = &rest[1..],
        "super" => {
            while rest.first().is_some_and(|name| name == "super") {
                base.pop();
                rest = &rest[1..];
            }
        }
        name if children.contains(name) => {}
        _ => return None,
    }
    base.extend_from_slice(rest);
    Some(base)
}

/// The file in which what `path` names is written: down the modules, through re-exports.
fn resolve(path: &Module, scanned: &BTreeMap<Module, Scan>, depth: usize) -> Module {
    let mut module = Module::new();
    for name in path {
        let below = child(&module, name);
        if scanned.contains_key(&below) {
            module = below;
            continue;
        }
        let scan = &scanned[&module];
        let named = scan.paths.iter().find(|path| path.re_export && path.name == *name);
        if let Some(start) = named.and_then(|named| absolute(&module, &named.names, &scan.children))
            && depth < 8
        {
            return resolve(&start, scanned, depth + 1);
        }
        break;
    }
    module
}

/// A path in a source file, from `crate`, `self`, `super` or a child on.
struct Named {
    names: Vec<String>,
    /// What the last name is called here.
    name: String,
    re_export: bool,
    line: usize,
}

/// What one file declares and names outside of its tests.
struct Scan {
    children: BTreeSet<String>,
    test_modules: Vec<String>,
    /// The line of a module with its text in this file that says `super`: not followed.
    inner_module: Option<usize>,
    paths: Vec<Named>,
}

impl Scan {
    fn new(source: &str) -> Self {
        let mut test_modules = Vec::new();
        let tokens = without_tests(tokens(source), &mut test_modules);
        let text = |at: usize| tokens.get(at).map_or("", |token| token.text.as_str());
        let mut scan =
            Self { children: BTreeSet::new(), test_modules, inner_module: None, paths: Vec::new() };
        for at in 0..tokens.len() {
            if text(at) == "mod" && text(at + 2) == ";" {
                scan.children.insert(text(at + 1).to_owned());
            }
            if text(at) == "mod" && text(at + 2) == "{" && names_super(&tokens[at + 3..]) {
                scan.inner_module = Some(tokens[at].line);
            }
        }
        let mut at = 0;
        while at < tokens.len() {
            if text(at) == "use" {
                let re_export = at > 0 && (text(at - 1) == "pub" || text(at - 1) == ")");
                let line = tokens[at].line;
                at = scan.read_use(&tokens, at + 1, &[], re_export, line);
            } else if text(at + 1) == "::"
                && !matches!(at.checked_sub(1).map(text), Some("::" | "in"))
            {
                let line = tokens[at].line;
                let mut names = vec![text(at).to_owned()];
                while text(at + 1) == "::" && is_name(text(at + 2)) {
                    names.push(text(at + 2).to_owned());
                    at += 2;
                }
                let name = names.last().cloned().unwrap_or_default();
                scan.paths.push(Named { names, name, re_export: false, line });
                at += 1;
            } else {
                at += 1;
            }
        }
        scan
    }

    /// Reads one tree of a `use` declaration and returns where it ends.
    fn read_use(
        &mut self,
        tokens: &[Token],
        mut at: usize,
        above: &[String],
        re_export: bool,
        line: usize,
    ) -> usize {
        let text = |at: usize| tokens.get(at).map_or("", |token| token.text.as_str());
        let mut names = above.to_vec();
        loop {
            match text(at) {
                "{" => {
                    at += 1;
                    while !matches!(text(at), "}" | "") {
                        at = self.read_use(tokens, at, &names, re_export, line);
                        at += usize::from(text(at) == ",");
                    }
                    return at + 1;
                }
                "::" => at += 1,
                "*" => {
                    self.paths.push(Named { names, name: "*".to_owned(), re_export, line });
                    return at + 1;
                }
                name if is_name(name) => {
                    // `a::{self}` is `a`.
                    if name != "self" || names.is_empty() {
                        names.push(name.to_owned());
                    }
                    at += 1;
                    if text(at) != "::" {
                        let mut name = names.last().cloned().unwrap_or_default();
                        if text(at) == "as" {
                            name = text(at + 1).to_owned();
                            at += 2;
                        }
                        self.paths.push(Named { names, name, re_export, line });
                        return at;
                    }
                }
                _ => return at + 1,
            }
        }
    }
}

/// Whether `super` occurs before the bracket closes that was open before the first token.
fn names_super(tokens: &[Token]) -> bool {
    let mut depth = 1;
    let inside = tokens.iter().take_while(|token| {
        depth += i32::from(token.text == "{") - i32::from(token.text == "}");
        depth > 0
    });
    inside.into_iter().any(|token| token.text == "super")
}

struct Token {
    text: String,
    line: usize,
}

fn is_name(text: &str) -> bool {
    text.starts_with(|first: char| first.is_alphabetic() || first == '_')
}

/// Names, `::` and single signs; comments, texts, characters and lifetimes are left out.
fn tokens(source: &str) -> Vec<Token> {
    let chars: Vec<char> = source.chars().collect();
    let get = |at: usize| chars.get(at).copied().unwrap_or('\0');
    let mut tokens = Vec::new();
    let (mut at, mut line, mut counted) = (0, 1, 0);
    while at < chars.len() {
        line += chars[counted..at].iter().filter(|&&c| c == '\n').count();
        counted = at;
        let start = at;
        match get(at) {
            '/' if get(at + 1) == '/' => {
                while at < chars.len() && get(at) != '\n' {
                    at += 1;
                }
            }
            '/' if get(at + 1) == '*' => {
                let mut depth = 1;
                at += 2;
                while at < chars.len() && depth > 0 {
                    let step = match (get(at), get(at + 1)) {
                        ('/', '*') => 1,
                        ('*', '/') => -1,
                        _ => 0,
                    };
                    depth += step;
                    at += if step == 0 { 1 } else { 2 };
                }
            }
            '"' => at = end_of_text(&get, at + 1, chars.len()),
            '\'' if get(at + 1) == '\\' || get(at + 2) == '\'' => {
                at += if get(at + 1) == '\\' { 3 } else { 2 };
                while at < chars.len() && get(at) != '\'' {
                    at += 1;
                }
                at += 1;
            }
            '\'' => at += 1 + (at + 1..).take_while(|&i| is_part_of_name(get(i))).count(),
            first if is_part_of_name(first) => {
                while is_part_of_name(get(at)) {
                    at += 1;
                }
                let name: String = chars[start..at].iter().collect();
                let hashes = (at..).take_while(|&i| get(i) == '#').count();
                if matches!(name.as_str(), "r" | "br") && get(at + hashes) == '"' {
                    at += hashes + 1;
                    while at < chars.len()
                        && !(get(at) == '"' && (1..=hashes).all(|i| get(at + i) == '#'))
                    {
                        at += 1;
                    }
                    at += hashes + 1;
                } else {
                    tokens.push(Token { text: name, line });
                }
            }
            ':' if get(at + 1) == ':' => {
                tokens.push(Token { text: "::".to_owned(), line });
                at += 2;
            }
            sign => {
                if !sign.is_whitespace() {
                    tokens.push(Token { text: sign.to_string(), line });
                }
                at += 1;
            }
        }
    }
    tokens
}

fn is_part_of_name(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

fn end_of_text(get: &impl Fn(usize) -> char, mut at: usize, len: usize) -> usize {
    while at < len && get(at) != '"' {
        at += if get(at) == '\\' { 2 } else { 1 };
    }
    at + 1
}

/// Leaves out every item behind `#[cfg(test)]`, and notes the modules among them.
fn without_tests(tokens: Vec<Token>, test_modules: &mut Vec<String>) -> Vec<Token> {
    const MARK: [&str; 7] = ["#", "[", "cfg", "(", "test", ")", "]"];
    let mut kept = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        let here = tokens[at..].iter().map(|token| token.text.as_str());
        if !here.take(MARK.len()).eq(MARK) {
            kept.push(Token { text: tokens[at].text.clone(), line: tokens[at].line });
            at += 1;
            continue;
        }
        at += MARK.len();
        // The item ends at its `;`, or at the bracket that closes its first block.
        let mut depth = 0_usize;
        while at < tokens.len() {
            match tokens[at].text.as_str() {
                "{" | "(" | "[" => depth += 1,
                "}" | ")" | "]" => depth = depth.saturating_sub(1),
                "mod" if depth == 0 => {
                    test_modules.extend(tokens.get(at + 1).map(|name| name.text.clone()));
                }
                _ => {}
            }
            at += 1;
            if depth == 0 && matches!(tokens[at - 1].text.as_str(), ";" | "}") {
                break;
            }
        }
    }
    kept
}
