//! Server of the page, with the data of a replay or the messages of a live run, and nothing else.
//!
//! | path | what |
//! |---|---|
//! | `/` | the page |
//! | `/viewer.js`, `/viewer.css` | its program and style, from this binary |
//! | `/film.json` | the replay of finished runs, if that is what is shown |
//! | `/live` | the line to a live run (WebSocket), if that is what is shown |
//!
//! No path leads to a file. Every request must name this server in `Host`, come from its own page if it names an
//! `Origin`, and carry the token ([`sincro_access::guard`]): a page of another site, a name that was pointed at this
//! machine and another user of it can neither look nor command. A head must come within ten seconds, and an address has
//! its share of the connections only.

mod connection;
mod socket;
mod timed_stream;

use std::io;
use std::net::{SocketAddr, TcpListener};
use std::sync::Arc;
use std::sync::mpsc::SyncSender;

use axum::extract::ws::WebSocketUpgrade;
use axum::extract::{Request, State};
use axum::http::{HeaderValue, StatusCode, header};
use axum::middleware::{self, Next};
use axum::response::{Html, IntoResponse, Redirect, Response};
use axum::routing::get;
use axum::{Extension, Router};

use serde_json::Value;
use sincro_access::{Guard, guard};

use connection::Line;

use crate::embed::{SCRIPT, STYLE};
use crate::live::{Command, LiveState};

/// Largest message of a viewer [bytes].
const MAX_BYTES: usize = 1 << 18;

/// Content that a [`Server`] shows in the browser.
#[derive(Clone)]
pub enum ViewerContent {
    /// Finished runs: the content of a `replay.json`.
    Replay(Arc<str>),
    /// A live scene: the state that its engine publishes, and the sender of commands to it.
    Live(Arc<LiveState>, SyncSender<Command>),
}

impl ViewerContent {
    /// Paths of the cameras of the scene that is shown, of its first run, in the order of the scene; empty if there are
    /// none.
    #[must_use]
    pub fn cameras(&self) -> Vec<String> {
        let parse = |text: &str| serde_json::from_str::<Value>(text).unwrap_or_default();
        let view = match self {
            Self::Replay(text) => parse(text)["views"][0].take(),
            Self::Live(live_state, _) => {
                live_state.read().runs.first().map_or(Value::Null, |run| parse(&run.header)["view"].take())
            }
        };
        let objects = view["objects"].as_array().into_iter().flatten();
        objects.filter(|o| o["camera"].is_object()).filter_map(|o| Some(o["path"].as_str()?.to_owned())).collect()
    }
}

#[derive(Clone)]
struct Shared {
    show: ViewerContent,
    guard: Arc<Guard>,
}

/// HTTP server of the viewer's page on one address; it serves as soon as it [runs](Self::run).
pub struct Server {
    listener: TcpListener,
    guard: Arc<Guard>,
    show: ViewerContent,
}

impl Server {
    /// Binds a TCP address for showing `show`; port 0 is any free one.
    ///
    /// # Errors
    ///
    /// The address is in use, not allowed, or none of this machine.
    pub fn bind(address: SocketAddr, show: ViewerContent) -> io::Result<Self> {
        let listener = TcpListener::bind(address)?;
        listener.set_nonblocking(true)?;
        let guard = Arc::new(Guard::for_page(listener.local_addr()?));
        Ok(Self { listener, guard, show })
    }

    /// Link to the page, with the token that every request needs: `http://127.0.0.1:PORT/?token=…`.
    #[must_use]
    pub fn url(&self) -> String {
        self.guard.link("http")
    }

    /// Link that opens the page once, for the argument list of a browser, which every user of the machine can read; an
    /// earlier one becomes void.
    #[must_use]
    pub fn single_use_url(&self) -> String {
        self.guard.single_use_link()
    }

    /// Serves until the process ends, in the calling thread.
    ///
    /// # Errors
    ///
    /// The network fails: a connection cannot be accepted any more.
    pub fn run(self) -> io::Result<()> {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        runtime.block_on(async {
            let listener = tokio::net::TcpListener::from_std(self.listener)?;
            let shared = Shared { show: self.show, guard: self.guard };
            connection::accept(listener, router(shared)).await
        })
    }
}

fn router(shared: Shared) -> Router {
    let script = |content: &'static str, kind: &'static str| {
        get(move || async move { ([(header::CONTENT_TYPE, kind)], content).into_response() })
    };
    Router::new()
        .route("/", get(page))
        .route("/viewer.js", script(SCRIPT, "text/javascript; charset=utf-8"))
        .route("/viewer.css", script(STYLE, "text/css; charset=utf-8"))
        .route("/film.json", get(replay))
        .route("/live", get(live))
        .layer(middleware::from_fn_with_state(shared.clone(), admit))
        .with_state(shared)
}

/// Admits a request or refuses it, and sets the headers that every answer has.
async fn admit(
    State(shared): State<Shared>,
    Extension(line): Extension<Arc<Line>>,
    request: Request,
    next: Next,
) -> Response {
    let mut response = match admission(&shared.guard, &request) {
        Ok(Admission::Static) => next.run(request).await,
        Ok(Admission::Full) => {
            // who has the token is no stranger: the connection is not the first to make room
            line.mark_message();
            next.run(request).await
        }
        Ok(Admission::Ticket) => Redirect::to(&format!("/?{}", shared.guard.token_query())).into_response(),
        Err(refused) => (StatusCode::FORBIDDEN, refused.0).into_response(),
    };
    let headers = response.headers_mut();
    let policy = "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src data: blob:; connect-src 'self'; \
                  base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
    headers.insert(header::CONTENT_SECURITY_POLICY, HeaderValue::from_static(policy));
    headers.insert(header::X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff"));
    headers.insert(header::REFERRER_POLICY, HeaderValue::from_static("no-referrer"));
    headers.insert(header::CACHE_CONTROL, HeaderValue::from_static("no-store"));
    headers.insert("cross-origin-resource-policy", HeaderValue::from_static("same-origin"));
    response
}

/// Extent to which a request is admitted.
enum Admission {
    /// To the page's own program and style, which carry no secrets and are asked for without a token.
    Static,
    /// To everything: it has the token.
    Full,
    /// To the link with the token: it has the ticket.
    Ticket,
}

fn admission(guard: &Guard, request: &Request) -> Result<Admission, guard::Refused> {
    let asked = asked(request)?;
    let path = request.uri().path();
    if path == "/" && guard.redeem(&asked) {
        return Ok(Admission::Ticket);
    }
    if matches!(path, "/viewer.js" | "/viewer.css") {
        return guard.check_without_token(&asked).map(|()| Admission::Static);
    }
    guard.check(&asked).map(|()| Admission::Full)
}

/// Parts of a request that decide about its admission; a header that stands twice, or a target that names another
/// server, leaves open which one counts and is refused.
fn asked(request: &Request) -> Result<guard::Request<'_>, guard::Refused> {
    let headers = request.headers();
    for name in [header::HOST, header::ORIGIN] {
        if headers.get_all(&name).iter().count() > 1 {
            return Err(guard::Refused(format!("the request has `{name}` twice")));
        }
    }
    if request.uri().authority().is_some() {
        return Err(guard::Refused("the request names a server in its target".into()));
    }
    let text = |name: header::HeaderName| headers.get(name).map(|value| value.to_str().unwrap_or("?"));
    Ok(guard::Request { host: text(header::HOST), origin: text(header::ORIGIN), query: request.uri().query() })
}

async fn page(State(shared): State<Shared>) -> Html<String> {
    let source = match shared.show {
        ViewerContent::Replay(_) => "film",
        ViewerContent::Live(..) => "live",
    };
    Html(format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" \
         content=\"width=device-width, initial-scale=1\">\n<meta name=\"color-scheme\" content=\"light dark\">\n<title>sincro</title>\n\
         <link rel=\"icon\" href=\"data:,\">\n<link rel=\"stylesheet\" href=\"viewer.css\">\n</head>\n<body>\n\
         <div id=\"sincro-viewer\" data-source=\"{source}\"><p class=\"sv-failed\">loading …</p></div>\n\
         <script src=\"viewer.js\"></script>\n</body>\n</html>\n"
    ))
}

async fn replay(State(shared): State<Shared>) -> Response {
    match shared.show {
        ViewerContent::Replay(replay) => {
            ([(header::CONTENT_TYPE, "application/json")], replay.to_string()).into_response()
        }
        ViewerContent::Live(..) => (StatusCode::NOT_FOUND, "this is a live run").into_response(),
    }
}

async fn live(
    State(shared): State<Shared>,
    Extension(line): Extension<Arc<Line>>,
    upgrade: WebSocketUpgrade,
) -> Response {
    match shared.show {
        ViewerContent::Replay(_) => (StatusCode::NOT_FOUND, "these are finished runs").into_response(),
        ViewerContent::Live(live_state, commands) => upgrade
            .max_message_size(MAX_BYTES)
            .max_frame_size(MAX_BYTES)
            .on_upgrade(move |socket| socket::attend(socket, line, live_state, commands)),
    }
}
