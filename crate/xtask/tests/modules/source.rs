//! The modules of one crate, read from its source: what each defines, imports and names.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use proc_macro2::{TokenStream, TokenTree};
use syn::visit::{self, Visit};

/// A path as it stands in the source.
#[derive(Clone, Debug)]
pub(crate) struct Mention {
    pub(crate) line: usize,
    pub(crate) path: Vec<String>,
}

/// One module: that of a file, or one in braces within it.
#[derive(Debug, Default)]
pub(crate) struct Module {
    pub(crate) file: PathBuf,
    /// The module that holds this one, and all that hold that one; the crate root has none.
    pub(crate) parent: Option<usize>,
    /// Modules of their own, by name.
    pub(crate) children: BTreeMap<String, usize>,
    /// Names of the items defined here.
    pub(crate) items: BTreeSet<String>,
    /// What a name stands for that `use` brings here.
    pub(crate) imports: BTreeMap<String, Vec<String>>,
    /// Modules whose names all are brought here.
    pub(crate) globs: Vec<Vec<String>>,
    /// Every path outside tests.
    pub(crate) mentions: Vec<Mention>,
}

/// Reads the crate with this root file. The first module is the root; the children of a module come after it.
pub(crate) fn read(root: &Path) -> Vec<Module> {
    let mut modules = vec![Module { file: root.to_owned(), ..Module::default() }];
    let folder = root.parent().unwrap_or(Path::new(""));
    read_file(&mut modules, 0, folder);
    modules
}

/// Reads the file of a module; those it declares are in `folder`.
fn read_file(modules: &mut Vec<Module>, index: usize, folder: &Path) {
    let file = modules[index].file.clone();
    let text = fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    let parsed = syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    if !is_test(&parsed.attrs) {
        read_items(modules, index, folder, &parsed.items);
    }
}

fn read_items(modules: &mut Vec<Module>, index: usize, folder: &Path, items: &[syn::Item]) {
    let mut reader = Reader { module: &mut modules[index], submodules: Vec::new() };
    for item in items {
        reader.visit_item(item);
    }
    for submodule in reader.submodules {
        let name = submodule.ident.to_string();
        let mut child =
            Module { parent: Some(index), file: modules[index].file.clone(), ..Module::default() };
        let child_index = modules.len();
        modules[index].children.insert(name.clone(), child_index);
        if let Some((_, items)) = &submodule.content {
            modules.push(child);
            read_items(modules, child_index, &folder.join(name), items);
            continue;
        }
        let beside = folder.join(&name).with_extension("rs");
        let mut inside = folder.join(&name);
        child.file = match path_attribute(&submodule.attrs) {
            Some(path) => modules[index].file.with_file_name(path),
            None if beside.is_file() => beside,
            None => inside.join("mod.rs"),
        };
        // The submodules of a file with a path of its own lie beside it.
        if path_attribute(&submodule.attrs).is_some() {
            inside = child.file.parent().map_or(inside, Path::to_owned);
        }
        modules.push(child);
        read_file(modules, child_index, &inside);
    }
}

/// The value of `#[path = "..."]`.
fn path_attribute(attributes: &[syn::Attribute]) -> Option<String> {
    attributes.iter().find_map(|attribute| match &attribute.meta {
        syn::Meta::NameValue(pair) if pair.path.is_ident("path") => match &pair.value {
            syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(text), .. }) => Some(text.value()),
            _ => None,
        },
        _ => None,
    })
}

/// Whether `#[cfg(test)]` or `#[test]` is among them.
fn is_test(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|attribute| match &attribute.meta {
        syn::Meta::List(list) => list.path.is_ident("cfg") && list.tokens.to_string() == "test",
        syn::Meta::Path(path) => path.is_ident("test"),
        syn::Meta::NameValue(_) => false,
    })
}

fn attributes_of(item: &syn::Item) -> &[syn::Attribute] {
    match item {
        syn::Item::Const(item) => &item.attrs,
        syn::Item::Enum(item) => &item.attrs,
        syn::Item::Fn(item) => &item.attrs,
        syn::Item::Impl(item) => &item.attrs,
        syn::Item::Macro(item) => &item.attrs,
        syn::Item::Mod(item) => &item.attrs,
        syn::Item::Static(item) => &item.attrs,
        syn::Item::Struct(item) => &item.attrs,
        syn::Item::Trait(item) => &item.attrs,
        syn::Item::Type(item) => &item.attrs,
        syn::Item::Use(item) => &item.attrs,
        _ => &[],
    }
}

/// Fills in a module from the syntax of its file.
struct Reader<'a, 'syntax> {
    module: &'a mut Module,
    submodules: Vec<&'syntax syn::ItemMod>,
}

impl Reader<'_, '_> {
    fn mention(&mut self, line: usize, path: Vec<String>) {
        self.module.mentions.push(Mention { line, path });
    }

    fn import(&mut self, line: usize, mut path: Vec<String>, tree: &syn::UseTree) {
        match tree {
            syn::UseTree::Path(tree) => {
                path.push(tree.ident.to_string());
                self.import(line, path, &tree.tree);
            }
            syn::UseTree::Group(group) => {
                group.items.iter().for_each(|tree| self.import(line, path.clone(), tree));
            }
            syn::UseTree::Glob(_) => {
                self.module.globs.push(path.clone());
                self.mention(line, path);
            }
            syn::UseTree::Name(tree) => self.import_as(line, path, &tree.ident, &tree.ident),
            syn::UseTree::Rename(tree) => self.import_as(line, path, &tree.ident, &tree.rename),
        }
    }

    fn import_as(&mut self, line: usize, mut path: Vec<String>, what: &syn::Ident, name: &syn::Ident) {
        let (what, mut name) = (what.to_string(), name.to_string());
        if what == "self" {
            // `use a::{self}` brings `a`, unless it is renamed.
            name = if name == "self" { path.last().cloned().unwrap_or_default() } else { name };
        } else {
            path.push(what);
        }
        self.module.imports.insert(name, path.clone());
        self.mention(line, path);
    }

    /// The paths among the tokens of a macro, whose syntax is its own.
    fn tokens(&mut self, tokens: TokenStream) {
        let mut path: Vec<String> = Vec::new();
        let mut line = 0;
        let mut colons = 0;
        for token in tokens {
            match token {
                TokenTree::Ident(word) if colons == 2 => path.push(word.to_string()),
                TokenTree::Ident(word) => {
                    self.mention(line, std::mem::replace(&mut path, vec![word.to_string()]));
                    line = word.span().start().line;
                }
                TokenTree::Punct(mark) if mark.as_char() == ':' => {
                    colons += 1;
                    continue;
                }
                TokenTree::Group(group) => self.tokens(group.stream()),
                _ => self.mention(line, std::mem::take(&mut path)),
            }
            colons = 0;
        }
        self.mention(line, path);
    }
}

impl<'syntax> Visit<'syntax> for Reader<'_, 'syntax> {
    fn visit_item(&mut self, item: &'syntax syn::Item) {
        if is_test(attributes_of(item)) {
            return;
        }
        let name = match item {
            syn::Item::Const(item) => Some(&item.ident),
            syn::Item::Enum(item) => Some(&item.ident),
            syn::Item::Fn(item) => Some(&item.sig.ident),
            syn::Item::Macro(item) => item.ident.as_ref(),
            syn::Item::Static(item) => Some(&item.ident),
            syn::Item::Struct(item) => Some(&item.ident),
            syn::Item::Trait(item) => Some(&item.ident),
            syn::Item::Type(item) => Some(&item.ident),
            _ => None,
        };
        self.module.items.extend(name.map(ToString::to_string));
        visit::visit_item(self, item);
    }

    fn visit_item_mod(&mut self, item: &'syntax syn::ItemMod) {
        self.submodules.push(item);
    }

    fn visit_item_use(&mut self, item: &'syntax syn::ItemUse) {
        self.import(item.use_token.span.start().line, Vec::new(), &item.tree);
    }

    fn visit_path(&mut self, path: &'syntax syn::Path) {
        let words: Vec<&syn::Ident> = path.segments.iter().map(|segment| &segment.ident).collect();
        let line = words.first().map_or(0, |word| word.span().start().line);
        self.mention(line, words.into_iter().map(ToString::to_string).collect());
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, call: &'syntax syn::Macro) {
        self.tokens(call.tokens.clone());
    }

    /// `pub(crate)` says who may use an item, and uses nothing itself.
    fn visit_vis_restricted(&mut self, _: &'syntax syn::VisRestricted) {}
}
