//! Public items of the library crates, read with `syn`: what a user can name, along public modules and re-exports.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use syn::{Attribute, Expr, ImplItem, Item, Lit, Meta, TraitItem, Type, UseTree, Visibility};

/// A public item with its place.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Entry {
    pub file: PathBuf,
    /// Line of the name, from 1.
    pub line: usize,
    /// Last line of the signature, or of the fields or variants.
    pub end: usize,
    /// `sincro_math::lanes::width`, `World::step`.
    pub name: String,
    pub doc: String,
}

/// A module with its source; the workspace is one whose children are the crates.
pub struct Module {
    pub name: String,
    is_public: bool,
    file: PathBuf,
    items: Vec<Item>,
    pub children: Vec<Module>,
}

/// A public item and the module that it is written in.
type Public<'a> = (&'a Module, &'a Item);

/// Reads the library crates that are to be published.
pub fn workspace(root: &Path) -> Result<Module, String> {
    let children = crates(root).iter().map(|folder| read_crate(folder)).collect::<Result<_, _>>()?;
    Ok(workspace_of(children))
}

fn workspace_of(children: Vec<Module>) -> Module {
    Module { name: String::new(), is_public: true, file: PathBuf::new(), items: Vec::new(), children }
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

/// Public items of all crates, those that several of them export once.
pub fn entries(workspace: &Module) -> Vec<Entry> {
    let mut all = Vec::new();
    for library in &workspace.children {
        let public = exposed(workspace, std::slice::from_ref(&library.name));
        let types: BTreeSet<String> = public.iter().filter_map(|(_, item)| type_name(item)).collect();
        all.extend(public.iter().flat_map(|(module, item)| of_item(module, item)));
        methods(library, &types, &mut all);
    }
    all.sort();
    all.dedup();
    all
}

/// Items that a public module exports, each with its methods, its own entry first; those of foreign crates, and those
/// that a macro makes, are left out.
pub fn exports(workspace: &Module, path: &[String]) -> Vec<Vec<Entry>> {
    let with_methods = |(module, item): &Public| {
        let mut entries = of_item(module, item);
        let home = workspace.children.iter().find(|library| module.file.starts_with(library.folder()));
        if let (Some(home), Some(name)) = (home, type_name(item)) {
            methods(home, &BTreeSet::from([name]), &mut entries);
        }
        entries
    };
    exposed(workspace, path).iter().map(with_methods).collect()
}

fn read_crate(folder: &Path) -> Result<Module, String> {
    let name = folder.file_name().map_or_else(String::new, |name| name.to_string_lossy().replace('-', "_"));
    read(name, true, folder.join("src/lib.rs"), &folder.join("src"))
}

impl Module {
    fn folder(&self) -> PathBuf {
        self.file.parent().map_or_else(PathBuf::new, Path::to_path_buf)
    }
}

/// Public items that can be named along a path.
fn exposed<'a>(workspace: &'a Module, path: &[String]) -> Vec<Public<'a>> {
    let mut public = Vec::new();
    if let Some((module, path)) = module_at(workspace, path) {
        expose(workspace, module, &mut path.clone(), &mut public, &mut BTreeSet::new());
    }
    // a name may lead to an item along several re-exports
    let mut seen = BTreeSet::new();
    public.retain(|(_, item)| seen.insert(std::ptr::from_ref(*item)));
    public
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
    public: &mut Vec<Public<'a>>,
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
            for (_, target) in targets(&item.tree) {
                re_export(root, &absolute(root, &target, module, path), public, seen);
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
fn re_export<'a>(root: &'a Module, target: &[String], public: &mut Vec<Public<'a>>, seen: &mut BTreeSet<Vec<String>>) {
    let Some((last, parents)) = target.split_last() else { return };
    if let Some((module, mut path)) = module_at(root, target) {
        expose(root, module, &mut path, public, seen);
    }
    let Some((module, mut path)) = module_at(root, parents) else { return };
    if last == "*" {
        expose(root, module, &mut path, public, seen);
        return;
    }
    if let [_] = path.as_slice() {
        exported_macros(module, last, public);
    }
    for item in &module.items {
        if item_name(item).is_some_and(|name| name == *last) {
            public.push((module, item));
        }
        // a re-export of a re-export
        if let Item::Use(item) = item {
            for (_, inner) in targets(&item.tree).into_iter().filter(|(name, _)| name == last) {
                let inner = absolute(root, &inner, module, &path);
                if inner != target {
                    re_export(root, &inner, public, seen);
                }
            }
        }
    }
}

/// Adds the macros of a name that a crate exports: they are at its root wherever they are written.
fn exported_macros<'a>(module: &'a Module, name: &str, public: &mut Vec<Public<'a>>) {
    for item in &module.items {
        if let Item::Macro(written) = item
            && written.ident.as_ref().is_some_and(|ident| ident == name)
            && written.attrs.iter().any(|a| a.path().is_ident("macro_export"))
        {
            public.push((module, item));
        }
    }
    for child in &module.children {
        exported_macros(child, name, public);
    }
}

/// The module that a path leads to, along the names under which modules are re-exported, and the path of its source.
fn module_at<'a>(root: &'a Module, names: &[String]) -> Option<(&'a Module, Vec<String>)> {
    let mut at = (root, Vec::new());
    for name in names {
        let (module, mut path) = at;
        if let Some(child) = module.children.iter().find(|child| child.name == *name) {
            path.push(name.clone());
            at = (child, path);
            continue;
        }
        let uses = module.items.iter().filter_map(|item| if let Item::Use(item) = item { Some(item) } else { None });
        let named = uses.flat_map(|item| targets(&item.tree)).filter(|(known, _)| known == name);
        at = named
            .map(|(_, target)| absolute(root, &target, module, &path))
            .find_map(|target| if target.is_empty() { None } else { module_at(root, &target) })?;
    }
    Some(at)
}

/// Paths that a `use` names, by their names at the source, each after the name that it gets (`*` for all of a module).
fn targets(tree: &UseTree) -> Vec<(String, Vec<String>)> {
    match tree {
        UseTree::Path(path) => {
            let first = path.ident.to_string();
            let below = targets(&path.tree).into_iter().map(|(name, rest)| match rest.as_slice() {
                [only] if only == "self" => (if name == "self" { first.clone() } else { name }, vec![first.clone()]),
                _ => (name, [vec![first.clone()], rest].concat()),
            });
            below.collect()
        }
        UseTree::Name(name) => vec![(name.ident.to_string(), vec![name.ident.to_string()])],
        UseTree::Rename(rename) => vec![(rename.rename.to_string(), vec![rename.ident.to_string()])],
        UseTree::Glob(_) => vec![("*".to_owned(), vec!["*".to_owned()])],
        UseTree::Group(group) => group.items.iter().flat_map(targets).collect(),
    }
}

/// A path from the root of the workspace; that of a foreign crate leads nowhere.
fn absolute(root: &Module, target: &[String], module: &Module, path: &[String]) -> Vec<String> {
    let mut at = path.to_vec();
    let mut rest = target;
    while let [first, others @ ..] = rest {
        match first.as_str() {
            "crate" => at.truncate(1),
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
    if is_local {
        return [at, rest.to_vec()].concat();
    }
    let is_ours = rest.first().is_some_and(|first| root.children.iter().any(|library| library.name == *first));
    if is_ours { rest.to_vec() } else { Vec::new() }
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
        Item::Macro(item) => item.ident.iter().map(|ident| entry(ident, line_of(ident), &item.attrs)).collect(),
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
        let folder = std::env::temp_dir().join(format!("xtask-items-{}", std::process::id()));
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
        let library = read_crate(&folder).unwrap();
        fs::remove_dir_all(&folder).unwrap();
        let names: Vec<String> = entries(&workspace_of(vec![library])).into_iter().map(|entry| entry.name).collect();
        assert_eq!(
            names,
            ["inner::deep", "hidden::Known", "Known::say", "open::LIMIT", "open::T", "T::act"].map(str::to_owned)
        );
    }
}
