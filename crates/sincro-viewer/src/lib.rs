//! Viewer adapter: live scenes and finished runs in the browser, in 3-D and with plots.
//!
//! [`replay`] gathers the data of finished runs; [`embed`] puts it into a page that opens without a server; [`live`]
//! runs a scene and [`server`] shows either to browsers. The page itself stands in `page/` (TypeScript, three.js,
//! uPlot), and its bundle is committed, so that building this crate needs no Node.
//!
//! Without the features `server` and `mcap` (both are default) there are replays and pictures alone, and no foreign
//! crate but serde and base64.

pub mod embed;
mod encoding;
#[cfg(feature = "server")]
pub mod live;
#[cfg(feature = "mcap")]
pub mod mcap;
pub mod picture;
pub mod replay;
#[cfg(feature = "server")]
mod save;
#[cfg(feature = "server")]
pub mod server;
mod vector;
