//! As much of HTTP/1.1 as a page needs that is served to this machine: one request a connection, a bounded number of
//! connections at once, each for a bounded time. It knows nothing of what is served.

use std::borrow::Cow;
use std::io::{self, Read, Write};
use std::net::{IpAddr, Shutdown, TcpListener, TcpStream};
use std::sync::Mutex;
use std::thread;
use std::time::{Duration, Instant};

/// How many connections are served at once; others wait.
const CONNECTIONS: usize = 32;
/// How long a connection may last, so that none that hangs takes the place of another for good.
const TIME: Duration = Duration::from_secs(30);
/// The longest head of a request, in bytes.
const MAX_HEAD: usize = 1 << 14;
/// How much of a body that is refused is read all the same, so that the client reads why instead of writing on.
const MAX_REFUSED: u64 = 1 << 30;
/// How long nothing is accepted after the system refused, as it does when there are too many files open.
const PAUSE: Duration = Duration::from_millis(100);

/// What answers a request.
pub struct Answer<'a> {
    /// The status and its reason.
    pub status: &'static str,
    /// Headers, each ended by a line break; the length is not among them.
    pub headers: String,
    /// The body.
    pub body: Cow<'a, [u8]>,
}

/// What is served.
pub trait Site: Sync {
    /// The answer to a GET of a path.
    fn get(&self, path: &str) -> Answer<'_>;

    /// The largest body, in bytes, that is taken by POST at a path; none if nothing is.
    fn takes(&self, path: &str) -> Option<usize>;

    /// The answer to a POST of a body at a path that takes it. Only one is at work at a time.
    fn post(&self, path: &str, body: &[u8]) -> Answer<'_>;
}

impl<'a> Answer<'a> {
    /// An answer that is a line of text.
    pub fn line(status: &'static str, line: impl Into<String>) -> Self {
        let body = line.into().into_bytes().into();
        Self { status, headers: "Content-Type: text/plain; charset=utf-8\r\n".to_owned(), body }
    }
}

/// Answers GET and HEAD by path, and POST where it is taken, for ever, or until no thread can be started. A request that
/// names another host than this machine is refused: a page from elsewhere could have let its own name lead here; and so is a
/// body that comes from the page of another.
///
/// # Errors
///
/// If the system gives no thread or does not say which address is served.
pub fn serve(listener: &TcpListener, site: &impl Site) -> io::Result<()> {
    let own = listener.local_addr()?.ip();
    let busy = Mutex::new(());
    let work = || loop {
        match listener.accept() {
            // A client that hangs up early is no fault.
            Ok((stream, _)) => drop(converse(&stream, own, site, &busy)),
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

/// What a request comes to.
enum Outcome<'a> {
    /// An answer, and whether its body is sent too.
    Answer(Answer<'a>, bool),
    /// A body of so many bytes is read first, for the path.
    Body(String, usize),
}

/// Reads a request and answers it.
fn converse(stream: &TcpStream, own: IpAddr, site: &impl Site, busy: &Mutex<()>) -> io::Result<()> {
    let mut timed = Timed { stream, end: Instant::now() + TIME };
    let (head, mut begun) = match head(&mut timed)? {
        Some((head, begun)) => (head, begun),
        None => {
            let refusal = Answer::line("431 Request Header Fields Too Large", "the request is too long\n");
            return send(&mut timed, &refusal, true);
        }
    };
    match understood(&head, own, site) {
        Outcome::Answer(answer, has_body) => {
            send(&mut timed, &answer, has_body)?;
            if head.starts_with("POST ") {
                // A body that nobody wants: closing while it comes would take the answer away.
                stream.shutdown(Shutdown::Write)?;
                io::copy(&mut timed.take(MAX_REFUSED), &mut io::sink())?;
            }
            Ok(())
        }
        Outcome::Body(path, length) => {
            let Ok(_busy) = busy.try_lock() else {
                return send(&mut timed, &Answer::line("503 Service Unavailable", "another map is being read\n"), true);
            };
            begun.truncate(length);
            begun.reserve_exact(length - begun.len());
            let left = (length - begun.len()) as u64;
            (&mut timed).take(left).read_to_end(&mut begun)?;
            if begun.len() < length {
                return Err(io::ErrorKind::UnexpectedEof.into());
            }
            let answer = site.post(&path, &begun);
            // The work is not the client's.
            timed.end = Instant::now() + TIME;
            send(&mut timed, &answer, true)
        }
    }
}

fn send(stream: &mut Timed<'_>, Answer { status, headers, body }: &Answer<'_>, has_body: bool) -> io::Result<()> {
    let head = format!("HTTP/1.1 {status}\r\n{headers}Content-Length: {}\r\nConnection: close\r\n\r\n", body.len());
    stream.write_all(head.as_bytes())?;
    if has_body {
        stream.write_all(body)?;
    }
    stream.flush()
}

/// The head of a request as text, without the empty line that ends it, and what was read of the body; none if it is too
/// long.
fn head(stream: &mut impl Read) -> io::Result<Option<(String, Vec<u8>)>> {
    let mut bytes = Vec::new();
    let mut chunk = [0; 1024];
    loop {
        let read = stream.read(&mut chunk)?;
        if read == 0 {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        bytes.extend(&chunk[..read]);
        if let Some(end) = bytes.windows(4).position(|window| window == b"\r\n\r\n") {
            return Ok(Some((String::from_utf8_lossy(&bytes[..end]).into_owned(), bytes.split_off(end + 4))));
        }
        if bytes.len() > MAX_HEAD {
            return Ok(None);
        }
    }
}

/// What a head comes to.
fn understood<'a>(head: &str, own: IpAddr, site: &'a impl Site) -> Outcome<'a> {
    let refused = |status, line: &str| Outcome::Answer(Answer::line(status, line), true);
    let mut lines = head.split("\r\n");
    let words: Vec<&str> = lines.next().unwrap_or_default().split(' ').collect();
    let [method, target, version] = words[..] else {
        return refused("400 Bad Request", "no request of HTTP/1.1\n");
    };
    if !version.starts_with("HTTP/1.") {
        return refused("505 HTTP Version Not Supported", "HTTP/1.1 is spoken here\n");
    }
    let fields: Vec<(&str, &str)> = lines.filter_map(|line| line.split_once(':')).collect();
    let all = |wanted: &'static str| {
        fields.iter().filter(move |(name, _)| name.eq_ignore_ascii_case(wanted)).map(|(_, value)| value.trim())
    };
    if !all("host").all(|host| is_own(host, own)) {
        return refused("403 Forbidden", "this page is served to this machine alone\n");
    }
    let path = target.split(['?', '#']).next().unwrap_or_default();
    match method {
        "GET" | "HEAD" => Outcome::Answer(site.get(path), method == "GET"),
        "POST" if site.takes(path).is_some() => {
            // Browsers say where a request comes from; a page of another origin could send one that needs no leave.
            let is_from_here = |origin: &str| all("host").any(|host| origin == format!("http://{host}"));
            if !all("origin").all(is_from_here) {
                return refused("403 Forbidden", "maps are taken from this page alone\n");
            }
            let lengths: Vec<&str> = all("content-length").collect();
            let (length, most) = (lengths.first().and_then(|length| length.parse::<usize>().ok()), site.takes(path));
            match (length, most) {
                (Some(length), Some(most)) if length <= most && lengths.len() == 1 => {
                    Outcome::Body(path.to_owned(), length)
                }
                (Some(_), Some(most)) if lengths.len() == 1 => {
                    let line = format!(
                        "the files are larger than {} MB together; name them on the command line of `zonal explore`\n",
                        most >> 20
                    );
                    refused("413 Content Too Large", &line)
                }
                _ => refused("411 Length Required", "a body needs its length\n"),
            }
        }
        _ => {
            let refusal =
                Answer::line("405 Method Not Allowed", "GET and HEAD are answered, and POST where maps are taken\n");
            Outcome::Answer(Answer { headers: refusal.headers + "Allow: GET, HEAD\r\n", ..refusal }, true)
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

    /// A page, a file that is larger than the system keeps for a client that reads nothing, and a place for short bodies.
    struct Pages;

    static LARGE: [u8; 1 << 25] = [7; 1 << 25];

    impl Site for Pages {
        fn get(&self, path: &str) -> Answer<'_> {
            match path {
                "/" => Answer::line("200 OK", "page"),
                "/large" => Answer { status: "200 OK", headers: String::new(), body: Cow::Borrowed(&LARGE) },
                _ => Answer::line("404 Not Found", "none"),
            }
        }

        fn takes(&self, path: &str) -> Option<usize> {
            (path == "/map").then_some(5000)
        }

        fn post(&self, _: &str, body: &[u8]) -> Answer<'_> {
            Answer::line("200 OK", format!("{} bytes, {}", body.len(), body.iter().map(|&b| u64::from(b)).sum::<u64>()))
        }
    }

    #[test]
    fn what_is_no_request_is_refused() {
        let own = "127.0.0.1".parse().expect("an address");
        let status = |head: &str| match understood(head, own, &Pages) {
            Outcome::Answer(answer, _) => answer.status[..3].to_owned(),
            Outcome::Body(path, length) => format!("{path} {length}"),
        };
        let local = "POST /map HTTP/1.1\r\nHost: localhost:1\r\n";
        for (head, wanted) in [
            ("GET / HTTP/1.1", "200"),
            ("GET /?a#b HTTP/1.0\r\nhost: localhost:1", "200"),
            ("GET / HTTP/1.1\r\nHost: example.org", "403"),
            ("GET / HTTP/1.1\r\nHost: localhost\r\nHOST: example.org", "403"),
            ("GET /x HTTP/1.1", "404"),
            ("PUT / HTTP/1.1", "405"),
            ("POST / HTTP/1.1\r\nContent-Length: 3", "405"),
            ("PUT /map HTTP/1.1\r\nContent-Length: 3", "405"),
            ("GET / HTTP/2", "505"),
            ("GET /", "400"),
            ("", "400"),
            (&format!("{local}Content-Length: 3"), "/map 3"),
            (&format!("{local}content-length: 5000\r\nOrigin: http://localhost:1"), "/map 5000"),
            (&format!("{local}Content-Length: 5001"), "413"),
            (&format!("{local}Content-Length: 3\r\nOrigin: http://example.org"), "403"),
            (&format!("{local}Content-Length: 3\r\nOrigin: http://localhost:2"), "403"),
            (&format!("{local}Content-Length: 3\r\nOrigin: null"), "403"),
            ("POST /map HTTP/1.1\r\nHost: example.org\r\nOrigin: http://example.org\r\nContent-Length: 3", "403"),
            ("POST /map HTTP/1.1\r\nOrigin: http://localhost\r\nContent-Length: 3", "403"),
            (local, "411"),
            (&format!("{local}Transfer-Encoding: chunked"), "411"),
            (&format!("{local}Content-Length: -3"), "411"),
            (&format!("{local}Content-Length: 99999999999999999999999"), "411"),
            (&format!("{local}Content-Length: 3\r\nContent-Length: 4"), "411"),
        ] {
            assert_eq!(status(head), wanted, "{head}");
        }
        let sends_body = |head: &str| matches!(understood(head, own, &Pages), Outcome::Answer(_, true));
        assert!(!sends_body("HEAD / HTTP/1.1"), "a body where none is wanted");
        let mut long = &vec![b'x'; 2 * MAX_HEAD][..];
        assert!(head(&mut long).expect("it is read").is_none() && long.len() >= MAX_HEAD - 1024);
        let mut cut = &b"GET / HTTP/1.1\r\n"[..];
        assert!(head(&mut cut).is_err());
        let mut begun = &b"POST / HTTP/1.1\r\n\r\nabc"[..];
        let (_, body) = head(&mut begun).expect("it is read").expect("it is short");
        assert_eq!(body, b"abc");
    }

    #[test]
    fn clients_that_do_not_read_hold_up_nobody() {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
        let address = listener.local_addr().expect("it has an address");
        thread::spawn(move || serve(&listener, &Pages));
        let send = |head: String, body: &[u8]| {
            let mut stream = TcpStream::connect(address).expect("it listens");
            stream.write_all(head.as_bytes()).expect("sent");
            stream.write_all(body).expect("sent");
            stream
        };
        let ask = |path: &str, host: &str| send(format!("GET {path} HTTP/1.1\r\nHost: {host}\r\n\r\n"), b"");
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
        let post = |length: usize, body: &[u8]| {
            send(format!("POST /map HTTP/1.1\r\nHost: localhost\r\nContent-Length: {length}\r\n\r\n"), body)
        };
        assert!(text(post(5000, &[2; 5000])).ends_with("5000 bytes, 10000"));
        // The whole of a body that is too large may be sent: the answer still arrives.
        let refused = text(post(1 << 22, &vec![0; 1 << 22]));
        assert!(refused.starts_with("HTTP/1.1 413 ") && refused.contains("name them on the command line"), "{refused}");
        let mut last = idle.pop().expect("there is one");
        let mut bytes = Vec::new();
        last.read_to_end(&mut bytes).expect("it is read in the end");
        assert!(bytes.ends_with(&LARGE), "{} bytes", bytes.len());
    }
}
