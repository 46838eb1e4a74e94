// A recording by the microphone, with its level: one press begins it, the next ends it.

import { at, say, tell } from "./elements.js";

/// How long a recording may last, s: of floats at 48 000 samples a second, 120 s are 23 MB.
const LONGEST = 120;
/// The quietest level that is shown, dB below full scale.
const QUIETEST = -60;
/// Bits a second where the browser has no uncompressed form: enough that a click stays sharp.
const BITS = 256_000;
const FORMS = ["audio/webm;codecs=pcm", "audio/webm;codecs=opus", "audio/mp4", "audio/ogg;codecs=opus"];
/// What a browser does for voices would move or take away clicks.
const PLAIN = { echoCancellation: false, noiseSuppression: false, autoGainControl: false };
/// Samples that the level is of: more than a frame of the screen has, so that no click is missed.
const LATELY = 2048;

let recorder;

/// The largest sample of late, from 0 (60 dB below full scale, or less) to 1.
function level(samples) {
  const peak = samples.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
  return Math.max(0, 1 - (20 * Math.log10(peak)) / QUIETEST);
}

/// Shows level and length until the recorder ends.
function watch(stream, began) {
  const context = new AudioContext();
  const analyser = context.createAnalyser();
  analyser.fftSize = LATELY;
  context.createMediaStreamSource(stream).connect(analyser);
  const samples = new Float32Array(LATELY);
  const step = () => {
    if (recorder === undefined) return context.close();
    const lasts = (performance.now() - began) / 1000;
    analyser.getFloatTimeDomainData(samples);
    at("level").value = level(samples);
    at("recorded").textContent = say("record.lasts", { lasts: lasts.toFixed(0) });
    if (lasts > LONGEST) recorder.stop();
    return requestAnimationFrame(step);
  };
  step();
}

function shown(recording) {
  at("record").textContent = say(recording ? "record.end" : "record.begin");
  at("recording").hidden = !recording;
}

async function begin(take) {
  const stream = await navigator.mediaDevices.getUserMedia({ audio: PLAIN });
  const mimeType = FORMS.find((form) => MediaRecorder.isTypeSupported(form));
  const parts = [];
  recorder = new MediaRecorder(stream, { mimeType, audioBitsPerSecond: BITS });
  recorder.ondataavailable = ({ data }) => parts.push(data);
  recorder.onstop = () => {
    const ending = recorder.mimeType.match(/webm|mp4|ogg/)?.[0] ?? "webm";
    recorder = undefined;
    for (const track of stream.getTracks()) track.stop();
    shown(false);
    take([new File(parts, `recording.${ending}`)]);
  };
  recorder.start();
  shown(true);
  watch(stream, performance.now());
}

/// `take` is given the recording as a file.
export function record(take) {
  let asking = false;
  at("record").addEventListener("click", async () => {
    if (asking) return;
    if (recorder !== undefined) {
      recorder.stop();
      return;
    }
    asking = true;
    try {
      await begin(take);
    } catch (error) {
      tell(say("failed.microphone", { message: error.message }));
    }
    asking = false;
  });
}
