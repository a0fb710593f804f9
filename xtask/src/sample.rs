//! `cargo xtask api-sample`: public items of the library crates, drawn at random, for a person to grade.
//!
//! The seed is the hash of the parent commit, so that nobody chooses the items and everybody draws the same. An item is
//! public if a user of its crate can name it: along public modules and re-exports. Items are types, traits, functions,
//! methods and constants; fields and variants are printed with their type.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use syn::{Attribute, Expr, ImplItem, Item, Lit, Meta, TraitItem, Type, UseTree, Visibility};

/// Items that are drawn.
const N_ITEMS: usize = 30;
/// Lines of a type that are printed at most.
const MAX_LINES: usize = 60;

/// A public item with its place.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Entry {
    file: PathBuf,
    /// Line of the name, from 1.
    line: usize,
    /// Last line of the signature, or of the fields or variants.
    end: usize,
    /// `sincro_math::lanes::width`, `World::step`.
    name: String,
    doc: String,
}

/// A module with its source.
struct Module {
    name: String,
    is_public: bool,
    file: PathBuf,
    items: Vec<Item>,
    children: Vec<Module>,
}

/// Prints the sample; false if the crates or the commit cannot be read.
pub fn print(root: &Path) -> bool {
    let Some(seed) = parent_commit(root) else {
        println!("the hash of the parent commit cannot be had from git");
        return false;
    };
    let mut all = Vec::new();
    for folder in crates(root) {
        match entries(&folder) {
            Ok(found) => all.extend(found),
            Err(problem) => {
                println!("{problem}");
                return false;
            }
        }
    }
    all.sort();
    println!("{N_ITEMS} of {} public items, seed {seed} (the parent commit)", all.len());
    println!("grade each: meaning, unit, shape, errors; an item that a user calls has an example");
    for (k, entry) in draw(all, &seed).iter().enumerate() {
        let shown = entry.file.strip_prefix(root.canonicalize().unwrap_or_default()).unwrap_or(&entry.file);
        println!("\n--- {:2}  {}   {}:{}", k + 1, entry.name, shown.display(), entry.line);
        for line in entry.doc.lines() {
            println!("    ///{line}");
        }
        let text = fs::read_to_string(&entry.file).unwrap_or_default();
        let n_lines = (entry.end + 1 - entry.line).min(MAX_LINES);
        for line in text.lines().skip(entry.line - 1).take(n_lines) {
            println!("    {line}");
        }
    }
    true
}

fn parent_commit(root: &Path) -> Option<String> {
    let output = Command::new("git").args(["rev-parse", "HEAD^"]).current_dir(root).output().ok()?;
    let hash = String::from_utf8(output.stdout).ok()?.trim().to_owned();
    (output.status.success() && hash.len() >= 16).then_some(hash)
}

/// Folders of the crates that have a library to be published.
fn crates(root: &Path) -> Vec<PathBuf> {
    let root = root.canonicalize().unwrap_or_else(|_| root.to_path_buf());
    let all = fs::read_dir(root.join("crates")).map(|all| all.flatten().map(|e| e.path()).collect());
    let mut all: Vec<PathBuf> = all.unwrap_or_default();
    let is_published = |folder: &Path| {
        fs::read_to_string(folder.join("Cargo.toml")).is_ok_and(|manifest| !manifest.contains("publish = false"))
    };
    all.retain(|folder| folder.join("src/lib.rs").is_file() && is_published(folder));
    all.sort();
    all
}

/// Draws items without replacement: Fisher–Yates with SplitMix64.
fn draw(mut all: Vec<Entry>, seed: &str) -> Vec<Entry> {
    let mut state = u64::from_str_radix(&seed[..16], 16).unwrap_or(0);
    let mut next = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    };
    let n = all.len().min(N_ITEMS);
    for k in 0..n {
        // the bias of a remainder is far below one item in a million
        let other = k + (next() % (all.len() - k) as u64) as usize;
        all.swap(k, other);
    }
    all.truncate(n);
    all
}

/// Public items of one crate.
fn entries(folder: &Path) -> Result<Vec<Entry>, String> {
    let name = folder.file_name().map_or_else(String::new, |name| name.to_string_lossy().replace('-', "_"));
    let root = read(name, true, folder.join("src/lib.rs"), &folder.join("src"))?;
    let mut public = Vec::new();
    expose(&root, &root, &mut Vec::new(), &mut public, &mut BTreeSet::new());
    let types: BTreeSet<String> = public.iter().filter_map(|(_, item)| type_name(item)).collect();
    let mut all: Vec<Entry> = public.iter().flat_map(|(module, item)| of_item(module, item)).collect();
    methods(&root, &types, &mut all);
    all.sort();
    all.dedup();
    Ok(all)
}

/// Reads a module and those below it, but for tests.
fn read(name: String, is_public: bool, file: PathBuf, folder: &Path) -> Result<Module, String> {
    let text = fs::read_to_string(&file).map_err(|e| format!("`{}` cannot be read: {e}", file.display()))?;
    let items = syn::parse_file(&text).map_err(|e| format!("`{}` cannot be parsed: {e}", file.display()))?.items;
    let mut children = Vec::new();
    for item in &items {
        let Item::Mod(module) = item else { continue };
        let child = module.ident.to_string();
        if module.content.is_some() || is_test(&module.attrs) {
            continue;
        }
        let places = [folder.join(format!("{child}.rs")), folder.join(&child).join("mod.rs")];
        let Some(place) = places.into_iter().find(|place| place.is_file()) else { continue };
        let below = folder.join(&child);
        children.push(read(child, matches!(module.vis, Visibility::Public(_)), place, &below)?);
    }
    Ok(Module { name, is_public, file, items, children })
}

fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|a| {
        matches!(&a.meta, Meta::List(list) if list.path.is_ident("cfg")
        && list.tokens.to_string().contains("test"))
    })
}

/// Collects the public items of a module that can be named from outside, those that it re-exports included.
fn expose<'a>(
    root: &'a Module,
    module: &'a Module,
    path: &mut Vec<String>,
    public: &mut Vec<(&'a Module, &'a Item)>,
    seen: &mut BTreeSet<Vec<String>>,
) {
    if !seen.insert(path.clone()) {
        return;
    }
    for item in &module.items {
        if visibility(item).is_some_and(|vis| matches!(vis, Visibility::Public(_))) {
            public.push((module, item));
        }
        if let Item::Use(item) = item
            && matches!(item.vis, Visibility::Public(_))
        {
            for target in targets(&item.tree) {
                re_export(root, &absolute(&target, module, path), public, seen);
            }
        }
    }
    for child in module.children.iter().filter(|child| child.is_public) {
        path.push(child.name.clone());
        expose(root, child, path, public, seen);
        path.pop();
    }
}

/// Adds what a re-export names: a module, an item of a module, or (`*`) all of a module.
fn re_export<'a>(
    root: &'a Module,
    target: &[String],
    public: &mut Vec<(&'a Module, &'a Item)>,
    seen: &mut BTreeSet<Vec<String>>,
) {
    let Some((last, parents)) = target.split_last() else { return };
    let find = |names: &[String]| {
        names.iter().try_fold(root, |module, name| module.children.iter().find(|child| child.name == *name))
    };
    if let Some(module) = find(target) {
        expose(root, module, &mut target.to_vec(), public, seen);
    }
    let Some(module) = find(parents) else { return };
    if last == "*" {
        expose(root, module, &mut parents.to_vec(), public, seen);
        return;
    }
    for item in &module.items {
        if item_name(item).is_some_and(|name| name == *last) {
            public.push((module, item));
        }
        // a re-export of a re-export
        if let Item::Use(item) = item {
            for inner in targets(&item.tree).into_iter().filter(|inner| inner.last() == Some(last)) {
                let inner = absolute(&inner, module, parents);
                if inner != target {
                    re_export(root, &inner, public, seen);
                }
            }
        }
    }
}

/// Paths that a `use` names, by their names at the source.
fn targets(tree: &UseTree) -> Vec<Vec<String>> {
    match tree {
        UseTree::Path(path) => {
            let below = targets(&path.tree).into_iter();
            below.map(|rest| [vec![path.ident.to_string()], rest].concat()).collect()
        }
        UseTree::Name(name) => vec![vec![name.ident.to_string()]],
        UseTree::Rename(rename) => vec![vec![rename.ident.to_string()]],
        UseTree::Glob(_) => vec![vec!["*".to_owned()]],
        UseTree::Group(group) => group.items.iter().flat_map(targets).collect(),
    }
}

/// A path from the root of the crate; that of another crate leads nowhere.
fn absolute(target: &[String], module: &Module, path: &[String]) -> Vec<String> {
    let mut at = path.to_vec();
    let mut rest = target;
    while let [first, others @ ..] = rest {
        match first.as_str() {
            "crate" => at.clear(),
            "self" => {}
            "super" => {
                at.pop();
            }
            _ => break,
        }
        rest = others;
    }
    let is_local = rest.len() < target.len()
        || rest.first().is_some_and(|first| {
            module.children.iter().any(|child| child.name == *first)
                || module.items.iter().any(|item| item_name(item).is_some_and(|name| name == *first))
        });
    if is_local { [at, rest.to_vec()].concat() } else { Vec::new() }
}

fn visibility(item: &Item) -> Option<&Visibility> {
    Some(match item {
        Item::Const(item) => &item.vis,
        Item::Enum(item) => &item.vis,
        Item::Fn(item) => &item.vis,
        Item::Static(item) => &item.vis,
        Item::Struct(item) => &item.vis,
        Item::Trait(item) => &item.vis,
        Item::Type(item) => &item.vis,
        Item::Union(item) => &item.vis,
        _ => return None,
    })
}

fn item_name(item: &Item) -> Option<String> {
    Some(match item {
        Item::Const(item) => item.ident.to_string(),
        Item::Fn(item) => item.sig.ident.to_string(),
        Item::Static(item) => item.ident.to_string(),
        Item::Trait(item) => item.ident.to_string(),
        Item::Type(item) => item.ident.to_string(),
        _ => return type_name(item),
    })
}

/// Name of a type with methods of its own.
fn type_name(item: &Item) -> Option<String> {
    Some(match item {
        Item::Enum(item) => item.ident.to_string(),
        Item::Struct(item) => item.ident.to_string(),
        Item::Union(item) => item.ident.to_string(),
        _ => return None,
    })
}

/// An item as an entry, and the methods of a trait.
fn of_item(module: &Module, item: &Item) -> Vec<Entry> {
    let entry = |ident: &proc_macro2::Ident, end: usize, attributes: &[Attribute]| {
        entry(module, &module.name, ident, end, attributes)
    };
    match item {
        Item::Const(item) => vec![entry(&item.ident, line_of(&item.ident), &item.attrs)],
        Item::Static(item) => vec![entry(&item.ident, line_of(&item.ident), &item.attrs)],
        Item::Type(item) => vec![entry(&item.ident, line_of(&item.ident), &item.attrs)],
        Item::Fn(item) => {
            vec![entry(&item.sig.ident, item.block.brace_token.span.open().start().line, &item.attrs)]
        }
        Item::Enum(item) => vec![entry(&item.ident, item.brace_token.span.close().start().line, &item.attrs)],
        Item::Struct(item) => {
            let end = match &item.fields {
                syn::Fields::Named(fields) => fields.brace_token.span.close().start().line,
                syn::Fields::Unnamed(fields) => fields.paren_token.span.close().start().line,
                syn::Fields::Unit => line_of(&item.ident),
            };
            vec![entry(&item.ident, end, &item.attrs)]
        }
        Item::Trait(item) => {
            let mut all = vec![entry(&item.ident, line_of(&item.ident), &item.attrs)];
            for inner in &item.items {
                if let TraitItem::Fn(method) = inner {
                    let ident = &method.sig.ident;
                    let end = method.sig.paren_token.span.close().start().line;
                    all.push(self::entry(module, &item.ident.to_string(), ident, end, &method.attrs));
                }
            }
            all
        }
        _ => Vec::new(),
    }
}

/// Public methods and constants of public types, wherever in the crate they are implemented.
fn methods(module: &Module, types: &BTreeSet<String>, all: &mut Vec<Entry>) {
    for item in &module.items {
        let Item::Impl(block) = item else { continue };
        let Type::Path(of) = block.self_ty.as_ref() else { continue };
        let owner = of.path.segments.last().map_or_else(String::new, |segment| segment.ident.to_string());
        if block.trait_.is_some() || !types.contains(&owner) {
            continue;
        }
        for inner in &block.items {
            match inner {
                ImplItem::Fn(method) if matches!(method.vis, Visibility::Public(_)) => {
                    let end = method.block.brace_token.span.open().start().line;
                    all.push(entry(module, &owner, &method.sig.ident, end, &method.attrs));
                }
                ImplItem::Const(item) if matches!(item.vis, Visibility::Public(_)) => {
                    all.push(entry(module, &owner, &item.ident, line_of(&item.ident), &item.attrs));
                }
                _ => {}
            }
        }
    }
    for child in &module.children {
        methods(child, types, all);
    }
}

fn entry(module: &Module, owner: &str, ident: &proc_macro2::Ident, end: usize, attributes: &[Attribute]) -> Entry {
    let lines: Vec<String> = attributes.iter().filter_map(doc_line).collect();
    let name = format!("{owner}::{ident}");
    Entry { file: module.file.clone(), line: line_of(ident), end, name, doc: lines.join("\n") }
}

/// Text of a doc attribute.
fn doc_line(attribute: &Attribute) -> Option<String> {
    let Meta::NameValue(pair) = &attribute.meta else { return None };
    let Expr::Lit(literal) = &pair.value else { return None };
    match &literal.lit {
        Lit::Str(text) if pair.path.is_ident("doc") => Some(text.value()),
        _ => None,
    }
}

fn line_of(ident: &proc_macro2::Ident) -> usize {
    ident.span().start().line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_can_be_named_along_modules_and_re_exports() {
        let folder = std::env::temp_dir().join(format!("xtask-sample-{}", std::process::id()));
        fs::create_dir_all(folder.join("src/open")).unwrap();
        let write = |name: &str, text: &str| fs::write(folder.join("src").join(name), text).unwrap();
        write("lib.rs", "mod hidden;\npub mod open;\npub use hidden::{Known, inner::deep};\npub(crate) fn own() {}\n");
        write(
            "hidden.rs",
            "mod inner;\n/// Known.\npub struct Known;\nimpl Known { /// Says.\n pub fn say() {} fn mute() {} }\npub fn no() {}",
        );
        fs::create_dir_all(folder.join("src/hidden")).unwrap();
        write("hidden/inner.rs", "pub fn deep() {}\npub fn deeper() {}");
        write("open/mod.rs", "pub const LIMIT: f64 = 1.0;\n#[cfg(test)]\nmod tests;\npub trait T {\n    fn act();\n}");
        let names: Vec<String> = entries(&folder).unwrap().into_iter().map(|entry| entry.name).collect();
        fs::remove_dir_all(&folder).unwrap();
        assert_eq!(
            names,
            ["inner::deep", "hidden::Known", "Known::say", "open::LIMIT", "open::T", "T::act"].map(str::to_owned)
        );
    }

    #[test]
    fn the_same_seed_draws_the_same_items() {
        let item = |line| Entry { file: PathBuf::new(), line, end: line, name: String::new(), doc: String::new() };
        let draw_with = |seed: &str| draw((0..200).map(item).collect(), seed);
        let (a, b) = (draw_with("0123456789abcdef"), draw_with("fedcba9876543210"));
        assert_eq!(a.len(), N_ITEMS);
        assert!(a == draw_with("0123456789abcdef") && a != b);
        assert_eq!(a.iter().map(|entry| entry.line).collect::<BTreeSet<_>>().len(), N_ITEMS, "none twice");
    }
}
