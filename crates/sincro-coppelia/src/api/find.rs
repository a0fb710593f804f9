//! Finding objects by the names that V-REP and CoppeliaSim clients use.
//!
//! With a leading `/`, `.` or `:` it is a path in aliases (CoppeliaSim 4.3 and later): levels may be skipped, `[i]`
//! takes the i-th match among the objects of its level, `{i}` the i-th match of the whole search, `*` and `?` stand for
//! any run and any character; `/arm/Script` is the object of the script on `/arm`, which functions that take scripts
//! take too. Free joints may be left out ([`super::tree`]). Copies that the scene language or V-REP has numbered
//! (`ball1`, `ball#0`) are counted after those called `ball`: `ball[0]`, `ball[1]`; as `ball{0}`, `ball{1}` where no
//! object of the level is called `ball`, or once those called `ball` have been counted. Without a leading sign it is a
//! name of V-REP: `joint`, `joint#` for the first of that name; `joint#0` for the object of that very name, or the
//! second of those called `joint`; `wall0` for the second of those called `wall` if it was loaded or copied at run time
//! and no object has that very name.

use super::ApiError;
use super::registry::{Entry, Handle, ObjectRegistry};
use sincro_conventions::object_paths::{Element, copied, element, fits, split_number};

/// Longest path that is looked for.
const MAX_PATH_LEN: usize = 1_000;

/// Options of [`ObjectRegistry::find`]. The default is that of a client: no calling object, the first match.
#[derive(Clone, Copy, Debug, Default)]
pub struct Search {
    /// Object of the calling script, at which the relative paths `.` and `..` start; none for clients.
    pub from: Option<Handle>,
    /// Match that is wanted of several, counted from 0, none: the first; `{i}` in the path wins over it.
    pub index: Option<usize>,
    /// Object below which a path without a leading sign is searched; none: such a text is a name of V-REP.
    pub below: Option<Handle>,
}

/// Counting of the numbered copies of a name among its matches.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Counting {
    /// The first match is wanted: none are counted.
    None,
    /// Those of levels where no object has the very name.
    CopiesIfAlone,
    /// All, after the objects of the very name.
    Copies,
}

/// Name and number of a name that ends with a number without leading zeros.
fn numbered(text: &str) -> Option<(&str, usize)> {
    let name = text.trim_end_matches(|c: char| c.is_ascii_digit());
    let digits = &text[name.len()..];
    let is_plain = !name.is_empty() && (digits == "0" || !digits.starts_with('0'));
    Some((name, digits.parse().ok().filter(|_| is_plain)?))
}

impl ObjectRegistry {
    /// Finds an object by a path (`/arm/joint2`, `./link`, `../gripper`) or by a name of V-REP (`joint`, `joint#0`).
    /// Levels of a path may be skipped; `[i]` and `{i}` pick among several matches, `*` and `?` match any characters.
    ///
    /// ```
    /// # let scene = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/free-body");
    /// use sincro_coppelia::api::Search;
    /// use sincro_coppelia::session::Session;
    ///
    /// let mut session = Session::open(&scene, &[], sincro_sim::Extensions::default(), None)?;
    /// let first = session.registry().entries().next().expect("a scene has objects").clone();
    /// assert_eq!(session.registry().find(&first.path, Search::default())?, first.handle);
    /// assert!(session.registry().find("/no-such-object", Search::default()).is_err());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// No object has that path or name (the message names the nearest), the path cannot be read, is longer than 1,000
    /// bytes, or is relative although no script asks.
    pub fn find(&self, text: &str, search: Search) -> Result<Handle, ApiError> {
        if text.len() > MAX_PATH_LEN {
            return Err(ApiError(format!("a path of {} bytes is longer than {MAX_PATH_LEN}", text.len())));
        }
        let found = match text.chars().next() {
            Some('/' | '.' | ':') => match (self.find_path(text, search)?, text.strip_prefix("..")) {
                // scripts are objects since CoppeliaSim 4.7: `..` is what they are on
                (None, Some(rest)) if search.below.is_none() && search.from.is_some() => {
                    self.find_path(&format!(".{rest}"), search)?
                }
                (found, _) => found,
            },
            _ if search.below.is_some() => {
                self.find_path(&format!("./{text}"), Search { from: search.below, ..search })?
            }
            _ => self.find_name(text),
        };
        let found = match found {
            None => self.find_script(text, search),
            found => found,
        };
        found.ok_or_else(|| self.missing(text))
    }

    /// A script by its path: scripts are objects below those that they are on since CoppeliaSim 4.7, called `Script`
    /// unless they are renamed. Here a script has the handle of its object.
    fn find_script(&self, text: &str, search: Search) -> Option<Handle> {
        let (object, name) = text.rsplit_once('/')?;
        let name = split_number(name, '[', ']').map_or(name, |(name, _)| name);
        if object.is_empty() || !matches!(name, "Script" | "script") {
            return None;
        }
        let own = self.find(object, search).ok()?;
        self.scene().scripts.iter().any(|script| script.object as i32 + 1 == own.0).then_some(own)
    }

    /// A name of V-REP, see the head of this file.
    fn find_name(&self, text: &str) -> Option<Handle> {
        let text = text.strip_suffix('#').unwrap_or(text);
        // scenes of V-REP 3 have the numbers of copies in the names
        if let Some(entry) = self.entries().find(|e| text.contains('#') && e.name == text) {
            return Some(entry.handle);
        }
        let (name, nth) = match text.rsplit_once('#') {
            Some((name, digits)) => (name, digits.parse::<usize>().ok()?.checked_add(1)?),
            None => (text, 0),
        };
        let found = self.entries().filter(|e| e.name == name).nth(nth).map(|e| e.handle);
        // V-REP 3 numbers what is loaded again: `wall`, `wall0`, `wall1`
        found.or_else(|| {
            let (name, nth) = numbered(text)?;
            let again = self.entries().filter(|e| e.name == name).nth(nth.checked_add(1)?)?;
            self.added.contains(&again.handle).then_some(again.handle)
        })
    }

    fn find_path(&self, text: &str, search: Search) -> Result<Option<Handle>, ApiError> {
        let (mut start, mut rest) = (None, text);
        // what hangs on no model looks in the whole scene
        let mut is_loose = false;
        // a client has no object: its relative paths begin at the world
        let own = || {
            let is_bare = matches!(text, "." | ".." | ":");
            let nobody = || ApiError(format!("`{text}` is the object of a script, and none asks"));
            if is_bare && search.from.is_none() { Err(nobody()) } else { Ok(search.from) }
        };
        if let Some(tail) = rest.strip_prefix("::").or_else(|| rest.strip_prefix(':')) {
            // models are not marked here: the outermost object of the tree is the model
            let mut at = own()?;
            while let Some(parent) = at.and_then(|h| self.visible_parent(h)) {
                at = Some(parent);
            }
            is_loose = at == search.from;
            (start, rest) = (at, tail);
        } else if rest.starts_with('.') {
            let mut at = own()?;
            rest = rest.strip_prefix("./").unwrap_or_else(|| if rest == "." { "" } else { rest });
            while let Some(tail) = rest.strip_prefix("..") {
                at = at.and_then(|h| self.visible_parent(h));
                rest = tail.strip_prefix('/').unwrap_or(tail);
            }
            start = at;
        }
        let rest = rest.trim_start_matches('/');
        if rest.is_empty() {
            return Ok(start);
        }
        let (rest, index) = match split_number(rest, '{', '}') {
            Some((rest, index)) => (rest, Some(index)),
            None => (rest, search.index),
        };
        let Some(elements) = rest.split('/').map(element).collect::<Option<Vec<_>>>() else {
            return Err(ApiError(format!("`{text}` is no path of objects")));
        };
        let counting = if index.is_some() { Counting::CopiesIfAlone } else { Counting::None };
        let levels = [Some(start), is_loose.then_some(None)];
        let found =
            levels.iter().flatten().find_map(|level| self.search(*level, &elements, counting, &mut index.unwrap_or(0)));
        if found.is_some() || index.is_none() {
            return Ok(found);
        }
        // a number beyond those of the very name counts its numbered copies, too
        Ok(levels
            .iter()
            .flatten()
            .find_map(|level| self.search(*level, &elements, Counting::Copies, &mut index.unwrap_or(0))))
    }

    /// Looks for the path among the objects of a level, then below them, until `left` matches were passed over.
    fn search(&self, level: Option<Handle>, path: &[Element], counting: Counting, left: &mut usize) -> Option<Handle> {
        let objects: Vec<&Entry> = self.level(level);
        let (first, more) = path.split_first()?;
        let (mut n_matches, mut taken) = (0, Vec::new());
        let (named, others): (Vec<&Entry>, Vec<&Entry>) =
            objects.iter().copied().partition(|o| fits(&first.pattern, &o.name));
        // numbered copies come after what has the very name
        let is_counted = first.among.is_some()
            || counting == Counting::Copies
            || counting == Counting::CopiesIfAlone && named.is_empty();
        let is_copy = |o: &&Entry| is_counted && copied(&o.name).is_some_and(|name| fits(&first.pattern, name));
        for object in named.into_iter().chain(others.into_iter().filter(is_copy)) {
            let is_wanted = first.among.is_none_or(|k| k == n_matches);
            n_matches += 1;
            if first.among.is_some() {
                taken.push(object.handle);
            }
            if !is_wanted {
                continue;
            }
            if more.is_empty() {
                if *left == 0 {
                    return Some(object.handle);
                }
                *left -= 1;
            } else if let Some(found) = self.search(Some(object.handle), more, counting, left) {
                return Some(found);
            }
        }
        // what a free joint carries is among the objects already
        let below = objects.iter().filter(|o| !taken.contains(&o.handle) && !self.is_left_out(o.handle));
        below.into_iter().find_map(|o| self.search(Some(o.handle), path, counting, left))
    }

    fn missing(&self, text: &str) -> ApiError {
        let name = text.rsplit('/').next().unwrap_or(text);
        let mut known: Vec<&str> = self.entries().flat_map(|e| [e.name.as_str(), e.path.as_str()]).collect();
        known.dedup();
        let near = sincro_scene::suggest::nearest(name, known.iter().copied());
        let hint = near.map(|n| format!(": did you mean `{n}`?")).unwrap_or_default();
        ApiError(format!("Object does not exist: `{text}`{hint}"))
    }
}
