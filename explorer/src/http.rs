//! As much of HTTP/1.1 as a page needs that is served to this machine: one request a connection, a bounded number of
//! connections at once, each for a bounded time. It knows nothing of what is served.

use std::io::{self, Read, Write};
use std::net::{IpAddr, TcpListener, TcpStream};
use std::thread;
use std::time::{Duration, Instant};

/// How many connections are served at once; others wait.
const CONNECTIONS: usize = 32;
/// How long a connection may last, so that none that hangs takes the place of another for good.
const TIME: Duration = Duration::from_secs(30);
/// The longest head of a request, in bytes.
const MAX_HEAD: usize = 1 << 14;
/// How long nothing is accepted after the system refused, as it does when there are too many files open.
const PAUSE: Duration = Duration::from_millis(100);

/// What answers a request.
pub struct Answer<'a> {
    /// The status and its reason.
    pub status: &'static str,
    /// Headers, each ended by a line break; the length is not among them.
    pub headers: String,
    /// The body.
    pub body: &'a [u8],
}

impl<'a> Answer<'a> {
    /// An answer that is a line of text.
    pub fn line(status: &'static str, line: &'static str) -> Self {
        Self { status, headers: "Content-Type: text/plain; charset=utf-8\r\n".to_owned(), body: line.as_bytes() }
    }
}

/// Answers GET and HEAD by path for ever, or until no thread can be started. A request that names another host than this
/// machine is refused: a page from elsewhere could have let its own name lead here.
///
/// # Errors
///
/// If the system gives no thread or does not say which address is served.
pub fn serve<'a>(listener: &TcpListener, answer: impl Fn(&str) -> Answer<'a> + Sync) -> io::Result<()> {
    let own = listener.local_addr()?.ip();
    let work = || loop {
        match listener.accept() {
            // A client that hangs up early is no fault.
            Ok((stream, _)) => drop(converse(&stream, own, &answer)),
            Err(_) => thread::sleep(PAUSE),
        }
    };
    thread::scope(|scope| (0..CONNECTIONS).try_for_each(|_| thread::Builder::new().spawn_scoped(scope, work).map(drop)))
}

/// A connection until its time is over.
struct Timed<'a> {
    stream: &'a TcpStream,
    end: Instant,
}

impl Timed<'_> {
    fn left(&self) -> io::Result<Option<Duration>> {
        match self.end.checked_duration_since(Instant::now()).filter(|left| !left.is_zero()) {
            None => Err(io::ErrorKind::TimedOut.into()),
            left => Ok(left),
        }
    }
}

impl Read for Timed<'_> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.stream.set_read_timeout(self.left()?)?;
        self.stream.read(bytes)
    }
}

impl Write for Timed<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.stream.set_write_timeout(self.left()?)?;
        self.stream.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()
    }
}

/// Reads a request and answers it.
fn converse<'a>(stream: &TcpStream, own: IpAddr, answer: &impl Fn(&str) -> Answer<'a>) -> io::Result<()> {
    let mut stream = Timed { stream, end: Instant::now() + TIME };
    let head = head(&mut stream)?;
    let (answer, has_body) = match head.as_deref().map(|head| answered(head, own, answer)) {
        Some(result) => result,
        None => (Answer::line("431 Request Header Fields Too Large", "the request is too long\n"), true),
    };
    let Answer { status, headers, body } = answer;
    let head = format!("HTTP/1.1 {status}\r\n{headers}Content-Length: {}\r\nConnection: close\r\n\r\n", body.len());
    stream.write_all(head.as_bytes())?;
    if has_body {
        stream.write_all(body)?;
    }
    stream.flush()
}

/// The head of a request as text, without the empty line that ends it; none if it is too long.
fn head(stream: &mut impl Read) -> io::Result<Option<String>> {
    let mut bytes = Vec::new();
    let mut chunk = [0; 1024];
    loop {
        let read = stream.read(&mut chunk)?;
        if read == 0 {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        bytes.extend(&chunk[..read]);
        if let Some(end) = bytes.windows(4).position(|window| window == b"\r\n\r\n") {
            return Ok(Some(String::from_utf8_lossy(&bytes[..end]).into_owned()));
        }
        if bytes.len() > MAX_HEAD {
            return Ok(None);
        }
    }
}

/// What answers a head, and whether the body is sent too.
fn answered<'a>(head: &str, own: IpAddr, answer: &impl Fn(&str) -> Answer<'a>) -> (Answer<'a>, bool) {
    let mut lines = head.split("\r\n");
    let words: Vec<&str> = lines.next().unwrap_or_default().split(' ').collect();
    let [method, target, version] = words[..] else {
        return (Answer::line("400 Bad Request", "no request of HTTP/1.1\n"), true);
    };
    if !version.starts_with("HTTP/1.") {
        return (Answer::line("505 HTTP Version Not Supported", "HTTP/1.1 is spoken here\n"), true);
    }
    let mut hosts = lines.filter_map(|line| line.split_once(':')).filter(|(name, _)| name.eq_ignore_ascii_case("host"));
    if !hosts.all(|(_, host)| is_own(host.trim(), own)) {
        return (Answer::line("403 Forbidden", "this page is served to this machine alone\n"), true);
    }
    match method {
        "GET" | "HEAD" => (answer(target.split(['?', '#']).next().unwrap_or_default()), method == "GET"),
        _ => {
            let refusal = Answer::line("405 Method Not Allowed", "GET and HEAD are answered\n");
            (Answer { headers: refusal.headers + "Allow: GET, HEAD\r\n", ..refusal }, true)
        }
    }
}

/// Whether a host, with or without a port, is this machine by its own names or the address that is served.
fn is_own(host: &str, own: IpAddr) -> bool {
    let is_port = |port: &str| !port.is_empty() && port.bytes().all(|byte| byte.is_ascii_digit());
    let name = host.rsplit_once(':').filter(|(_, port)| is_port(port)).map_or(host, |(name, _)| name);
    let is_served = || name.trim_start_matches('[').trim_end_matches(']').parse() == Ok(own);
    name.eq_ignore_ascii_case("localhost") || name == "127.0.0.1" || name == "[::1]" || is_served()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_this_machine_is_its_own_host() {
        let own = "192.0.2.7".parse().expect("an address");
        for host in ["localhost", "LOCALHOST:8000", "127.0.0.1", "127.0.0.1:1", "[::1]:80", "[::1]", "192.0.2.7:80"] {
            assert!(is_own(host, own), "{host}");
        }
        for host in
            ["", "example.org", "localhost.example.org", "127.0.0.1.example.org:80", "192.0.2.8", "[::2]", "::1:"]
        {
            assert!(!is_own(host, own), "{host}");
        }
    }

    #[test]
    fn what_is_no_request_is_refused() {
        let own = "127.0.0.1".parse().expect("an address");
        let page = |path: &str| match path {
            "/" => Answer::line("200 OK", "page"),
            _ => Answer::line("404 Not Found", "none"),
        };
        let status = |head: &str| answered(head, own, &page).0.status[..3].to_owned();
        for (head, wanted) in [
            ("GET / HTTP/1.1", "200"),
            ("GET /?a#b HTTP/1.0\r\nhost: localhost:1", "200"),
            ("GET / HTTP/1.1\r\nHost: example.org", "403"),
            ("GET / HTTP/1.1\r\nHost: localhost\r\nHOST: example.org", "403"),
            ("GET /x HTTP/1.1", "404"),
            ("PUT / HTTP/1.1", "405"),
            ("GET / HTTP/2", "505"),
            ("GET /", "400"),
            ("", "400"),
        ] {
            assert_eq!(status(head), wanted, "{head}");
        }
        assert!(!answered("HEAD / HTTP/1.1", own, &page).1, "a body where none is wanted");
        let mut long = &vec![b'x'; 2 * MAX_HEAD][..];
        assert!(head(&mut long).expect("it is read").is_none() && long.len() >= MAX_HEAD - 1024);
        let mut cut = &b"GET / HTTP/1.1\r\n"[..];
        assert!(head(&mut cut).is_err());
    }

    #[test]
    fn clients_that_do_not_read_hold_up_nobody() {
        // More than the system keeps for a client that reads nothing.
        static LARGE: [u8; 1 << 25] = [7; 1 << 25];
        let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
        let address = listener.local_addr().expect("it has an address");
        thread::spawn(move || {
            serve(&listener, |path| match path {
                "/large" => Answer { status: "200 OK", headers: String::new(), body: &LARGE },
                _ => Answer::line("200 OK", "page"),
            })
        });
        let ask = |path: &str, host: &str| {
            let mut stream = TcpStream::connect(address).expect("it listens");
            write!(stream, "GET {path} HTTP/1.1\r\nHost: {host}\r\n\r\n").expect("sent");
            stream
        };
        let text = |mut stream: TcpStream| {
            let mut text = String::new();
            stream.read_to_string(&mut text).expect("answered");
            text
        };
        let mut idle: Vec<TcpStream> = (0..CONNECTIONS / 2).map(|_| ask("/large", "localhost")).collect();
        // Each of them has been answered, so that a thread is busy with it.
        idle.iter_mut().for_each(|stream| stream.read_exact(&mut [0; 12]).expect("it begins"));
        assert!(text(ask("/", "localhost")).ends_with("Connection: close\r\n\r\npage"));
        assert!(text(ask("/", "rebound.example.org")).starts_with("HTTP/1.1 403 "));
        let mut last = idle.pop().expect("there is one");
        let mut bytes = Vec::new();
        last.read_to_end(&mut bytes).expect("it is read in the end");
        assert!(bytes.ends_with(&LARGE), "{} bytes", bytes.len());
    }
}
