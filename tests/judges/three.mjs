// Reads models with three.js, or lets the Khronos validator read them, and prints one JSON object for each line of input.
//
// Input as for assimp.cc. Arguments: the folder with node_modules, and `three` or `validator`.
import fs from 'node:fs';
import path from 'node:path';
import readline from 'node:readline';
import { createRequire } from 'node:module';
import { pathToFileURL } from 'node:url';

const [folder, which, wantsVersion] = process.argv.slice(2);
const require = createRequire(pathToFileURL(path.join(path.resolve(folder), 'package.json')));
const load = name => import(pathToFileURL(path.join(path.resolve(folder), 'node_modules', name)));
const version = name => JSON.parse(fs.readFileSync(path.join(folder, 'node_modules', name, 'package.json'))).version;

if (wantsVersion) {
  console.log(version(which === 'three' ? 'three' : 'gltf-validator'));
  process.exit(0);
}

console.warn = () => {};

const answer = (id, value) => fs.writeSync(1, `${JSON.stringify({ id, ...value })}\n`);

async function validate(file) {
  const report = await require('gltf-validator').validateBytes(new Uint8Array(fs.readFileSync(file)), {
    uri: path.basename(file),
    maxIssues: 200,
    externalResourceFunction: uri => fs.promises.readFile(path.resolve(path.dirname(file), decodeURIComponent(uri)))
      .then(data => new Uint8Array(data)),
  });
  const errors = report.issues.messages.filter(message => message.severity === 0);
  return { errors: errors.map(message => `${message.code} at ${message.pointer ?? message.offset}`) };
}

// Returns a document without images, because node decodes none.
function withoutImages(file) {
  const data = fs.readFileSync(file);
  let json = null;
  let binary = null;
  if (data.readUInt32LE(0) === 0x46546c67) {
    for (let at = 12; at + 8 <= data.length; at += 8 + Math.ceil(data.readUInt32LE(at) / 4) * 4) {
      const body = data.subarray(at + 8, at + 8 + data.readUInt32LE(at));
      if (json === null) json = JSON.parse(body.toString());
      else binary ??= body;
    }
  } else {
    json = JSON.parse(data.toString());
  }
  for (const buffer of json.buffers ?? []) {
    if (buffer.uri?.startsWith('data:')) continue;
    const bytes = buffer.uri === undefined
      ? binary : fs.readFileSync(path.join(path.dirname(file), decodeURIComponent(buffer.uri)));
    buffer.uri = `data:application/octet-stream;base64,${bytes.toString('base64')}`;
  }
  for (const unused of ['images', 'textures', 'samplers']) delete json[unused];
  json.materials = json.materials?.map(({ name }) => ({ name }));
  const kept = extension => extension === 'KHR_mesh_quantization';
  json.extensionsUsed = json.extensionsUsed?.filter(kept);
  json.extensionsRequired = json.extensionsRequired?.filter(kept);
  return JSON.stringify(json);
}

// three.js adds the offset of a joint to its position channels, which have it already in the files of most programs.
function withoutOffsets(text) {
  return text.replace(/OFFSET[^\n]*(\s*CHANNELS[^\n]*position)/g, 'OFFSET 0 0 0$1');
}

let THREE;
const loaders = {};

// Returns the root of a scene, its clips, and the key of an object: its name, or `#` and the number of its node.
async function open(file, format) {
  if (format === 'glb' || format === 'gltf') {
    const gltf = await loaders.gltf.parseAsync(withoutImages(file), '');
    const root = new THREE.Group();
    gltf.scenes.forEach(scene => root.add(scene));
    const key = object => {
      const node = gltf.parser.associations.get(object)?.nodes;
      return node === undefined ? null : `#${node}`;
    };
    return { root, clips: gltf.animations, key };
  }
  const key = object => (object.name === '' || object.name === 'ENDSITE' ? null : object.name);
  if (format === 'bvh') {
    const { skeleton, clip } = loaders.bvh.parse(withoutOffsets(fs.readFileSync(file, 'utf8')));
    const root = new THREE.Group();
    skeleton.bones.filter(bone => bone.parent === null).forEach(bone => root.add(bone));
    return { root, clips: [clip], key };
  }
  if (format === 'fbx') {
    const data = fs.readFileSync(file);
    const root = loaders.fbx.parse(data.buffer.slice(data.byteOffset, data.byteOffset + data.byteLength), '');
    return { root, clips: root.animations, key };
  }
  return { root: loaders.obj.parse(fs.readFileSync(file, 'utf8')), clips: [], key };
}

function positions(root) {
  const all = [];
  root.updateMatrixWorld(true);
  root.traverse(object => {
    const position = object.geometry?.attributes.position;
    const at = new THREE.Vector3();
    for (let vertex = 0; vertex < (position?.count ?? 0); vertex++) {
      all.push(at.fromBufferAttribute(position, vertex).applyMatrix4(object.matrixWorld).toArray());
    }
  });
  return all;
}

async function look(file, format, take, name, times) {
  const { root, clips, key } = await open(file, format);
  if (format === 'obj') return { vertices: positions(root) };
  const clip = take < 0 ? null : clips.find(clip => clip.name === name) ?? clips[take];
  if (clip === undefined) return { error: 'the animation is missing' };
  const poses = times.map(time => {
    const mixer = new THREE.AnimationMixer(root);
    if (clip !== null) {
      const action = mixer.clipAction(clip);
      action.setLoop(THREE.LoopOnce);
      action.clampWhenFinished = true;
      action.play();
      mixer.update(time);
    }
    root.updateMatrixWorld(true);
    const bones = [];
    root.traverse(object => {
      const name = key(object);
      if (name !== null) bones.push([name, new THREE.Vector3().setFromMatrixPosition(object.matrixWorld).toArray()]);
    });
    mixer.stopAllAction();
    mixer.uncacheRoot(root);
    return bones;
  });
  return { poses };
}

if (which === 'three') {
  // What a browser has and node lacks.
  globalThis.self ??= globalThis;
  globalThis.window ??= globalThis;
  globalThis.document ??= { createElementNS: () => ({ addEventListener() {}, removeEventListener() {}, set src(_) {} }) };
  globalThis.ProgressEvent ??= class extends Event {};
  THREE = await load('three/build/three.module.js');
  const jsm = 'three/examples/jsm/loaders';
  const { GLTFLoader } = await load(`${jsm}/GLTFLoader.js`);
  const { BVHLoader } = await load(`${jsm}/BVHLoader.js`);
  const { FBXLoader } = await load(`${jsm}/FBXLoader.js`);
  const { OBJLoader } = await load(`${jsm}/OBJLoader.js`);
  Object.assign(loaders, { gltf: new GLTFLoader(), bvh: new BVHLoader(), fbx: new FBXLoader(), obj: new OBJLoader() });
}

for await (const line of readline.createInterface({ input: process.stdin })) {
  const [id, file, format, take, name, times] = line.split('\t');
  try {
    const work = which === 'three'
      ? look(file, format, Number(take), name, times.split(',').map(Number)) : validate(file);
    answer(id, await work);
  } catch (error) {
    answer(id, { error: String(error.message ?? error).slice(0, 200) });
  }
}
