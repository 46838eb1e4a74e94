// What three.js makes of a .glb: for each animation the lowest point and the volume of each ball at given times, and what Khronos' validator says.
import { readFileSync } from "node:fs";
import validator from "gltf-validator";

globalThis.self = globalThis;
const { AnimationMixer, Matrix3 } = await import("three");
const { GLTFLoader } = await import("three/addons/loaders/GLTFLoader.js");

const [file, times] = [process.argv[2], JSON.parse(process.argv[3])];
const bytes = readFileSync(file);
const report = await validator.validateBytes(new Uint8Array(bytes));
const gltf = await new GLTFLoader().parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), "");

const balls = [];
gltf.scene.traverse((node) => {
  // A ball may have two meshes, of two colours.
  if (!node.isMesh || gltf.parser.associations.get(node)?.primitives) return;
  node.geometry.computeBoundingBox();
  const box = node.geometry.boundingBox;
  const size = box.max.clone().sub(box.min);
  // The ground is a strip of few corners.
  if (node.geometry.attributes.position.count > 100) balls.push({ node, size: 0.5 * size.y, centre: box.min.clone().add(box.max).multiplyScalar(0.5) });
});

const animations = {};
for (const clip of gltf.animations) {
  const mixer = new AnimationMixer(gltf.scene);
  mixer.clipAction(clip).play();
  animations[clip.name] = times.map((t) => {
    mixer.setTime(Math.min(t, clip.duration * (1 - 1e-12)));
    gltf.scene.updateMatrixWorld(true);
    return balls.map((ball) => {
      const m = ball.node.matrixWorld;
      const e = m.elements;
      const low = ball.centre.clone().applyMatrix4(m).y - ball.size * Math.hypot(e[1], e[5], e[9]);
      return [low, new Matrix3().setFromMatrix4(m).determinant()];
    });
  });
  mixer.stopAllAction();
  mixer.uncacheRoot(gltf.scene);
}
console.log(JSON.stringify({ issues: report.issues.messages, errors: report.issues.numErrors, animations }));
