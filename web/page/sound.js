// Recordings that are no WAV: opened by the browser's own decoder, and handed on as WAV.

/// The rate that sounds are opened at, samples a second: that of nearly all recordings.
const RATE = 48_000;
const ENDINGS = /\.(m4a|mp4|mp3|aac|ogg|oga|opus|flac|webm|3gp)$/i;
/// What stands before the samples of a WAV file, bytes; and the numbers of its form.
const HEAD = 44;
const INTEGERS = 1;
const BYTES = 2;

/// A WAV file of integers of 16 bits.
function wav(sound) {
  const { length, numberOfChannels: channels, sampleRate } = sound;
  const size = length * channels * BYTES;
  const bytes = new Uint8Array(HEAD + size);
  const view = new DataView(bytes.buffer);
  const word = (at, letters) => bytes.set(new TextEncoder().encode(letters), at);
  word(0, "RIFF");
  view.setUint32(4, HEAD - 8 + size, true);
  word(8, "WAVEfmt ");
  view.setUint32(16, 16, true);
  view.setUint16(20, INTEGERS, true);
  view.setUint16(22, channels, true);
  view.setUint32(24, sampleRate, true);
  view.setUint32(28, sampleRate * channels * BYTES, true);
  view.setUint16(32, channels * BYTES, true);
  view.setUint16(34, 8 * BYTES, true);
  word(36, "data");
  view.setUint32(40, size, true);
  const samples = Array.from({ length: channels }, (_, channel) => sound.getChannelData(channel));
  for (let n = 0, at = HEAD; n < length; n += 1) {
    for (const { [n]: value } of samples) {
      view.setInt16(at, Math.round(32767 * Math.max(-1, Math.min(1, value))), true);
      at += BYTES;
    }
  }
  return bytes;
}

/// The file, or the WAV file of its sound; a sound that the browser cannot open stays as it is.
export async function heard(file) {
  if (!ENDINGS.test(file.name)) return file;
  try {
    const sound = await new OfflineAudioContext(1, 1, RATE).decodeAudioData(file.bytes.slice().buffer);
    return { name: file.name.replace(ENDINGS, ".wav"), bytes: wav(sound) };
  } catch {
    return file;
  }
}
