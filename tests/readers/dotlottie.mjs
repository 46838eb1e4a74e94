// What LottieFiles' player makes of a .lottie: its manifest, how many frames it plays and how long, or why it does not.
import { readFileSync } from "node:fs";
import { DotLottie } from "@lottiefiles/dotlottie-web";

const program = readFileSync(new URL("dotlottie-player.wasm", import.meta.resolve("@lottiefiles/dotlottie-web")));
DotLottie.setWasmUrl("data:application/wasm;base64," + program.toString("base64"));
const data = new Uint8Array(readFileSync(process.argv[2])).buffer;
const player = new DotLottie({ canvas: { width: 64, height: 64 }, data, autoplay: false });
await new Promise((done, fail) => {
  player.addEventListener("load", done);
  player.addEventListener("loadError", (event) => fail(event.error));
});
const { version, animations } = player.manifest;
console.log(JSON.stringify({ version, animations: animations.map(({ id }) => id), frames: player.totalFrames, duration: player.duration }));
process.exit(0);
