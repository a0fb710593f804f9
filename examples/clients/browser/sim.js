// The remote API in a browser, over WebSocket: `sim.getObject("/joint")` is a promise of what the server answers.
//
//     const sim = await connect("ws://127.0.0.1:23050/?token=…");   // the link that `sincro serve` prints
//     const joint = await sim.getObject("/shoulder");
//
// A call with several results gives a list, as in Python. Errors of the server are thrown with its text.

/** Connects to `sincro serve` with the link that it prints (pages need its token); every function of `sim` (docs/remote.md) is a function of what is given, and `close`. */
async function connect(url) {
  const socket = new WebSocket(url);
  await new Promise((open, failed) => {
    socket.onopen = open;
    socket.onerror = () => failed(new Error(`no connection to ${url}: start \`sincro serve SCENE\` and take the link that it prints`));
  });
  // answers come in the order of the questions
  const waiting = [];
  socket.onmessage = ({ data }) => {
    const { success, ret, error } = JSON.parse(data);
    const { done, failed } = waiting.shift();
    if (success) done(ret.length > 1 ? ret : ret[0]);
    else failed(new Error(error));
  };
  socket.onclose = () => waiting.splice(0).forEach(({ failed }) => failed(new Error("the server has closed the connection")));
  const call = (func, args) =>
    new Promise((done, failed) => {
      waiting.push({ done, failed });
      socket.send(JSON.stringify({ func, args }));
    });
  const own = { close: () => socket.close(), then: undefined };
  const stepping = ["setStepping", "step"];
  return new Proxy(own, {
    get: (_, name) => (name in own ? own[name] : (...args) => call(stepping.includes(name) ? name : `sim.${name}`, args)),
  });
}
