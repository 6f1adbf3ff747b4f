// Materials whose light is worked out at vertices and whose colours are written as they are seen: where a processor draws,
// pictures take half of the time that lights at each pixel cost.
import * as THREE from 'three';

/** Light from the sky and from the sun, in axes of the world; colours are light that adds (linear) up to the last line. */
const lit = `
  uniform vec3 sky, sun;
  varying vec3 seen;
  vec3 shown(vec3 colour, vec3 n) {
    float fromSky = 0.5 + 0.5 * dot(n, sky), fromSun = max(dot(n, sun), 0.0);
    vec3 light = mix(vec3(0.29, 0.275, 0.25), vec3(0.60), fromSky) + fromSun * vec3(0.63, 0.615, 0.59);
    return pow(min(colour * light, vec3(1.0)), vec3(1.0 / 2.2));
  }`;
const passOn = 'varying vec3 seen; void main() { gl_FragColor = vec4(seen, 1.0); }';

/** Of colours at the vertices (`colour` null), or of one colour. */
export function litMaterial(colour, sky, sun, more = {}) {
  return new THREE.ShaderMaterial({
    uniforms: {sky: {value: sky}, sun: {value: sun}, colour: {value: new THREE.Color(colour ?? 'white')}},
    vertexShader: `${colour ? 'uniform vec3 colour;' : 'attribute vec3 color;'} ${lit}
      void main() {
        seen = shown(${colour ? 'colour' : 'color'}, normal);
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
      }`,
    fragmentShader: passOn,
    ...more,
  });
}

/** One colour, without light. */
export function flatMaterial(colour, more = {}) {
  const [r, g, b] = [1, 3, 5].map((i) => (parseInt(colour.slice(i, i + 2), 16) / 255).toFixed(4));
  return new THREE.ShaderMaterial({
    vertexShader: 'void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }',
    fragmentShader: `void main() { gl_FragColor = vec4(${r}, ${g}, ${b}, 1.0); }`,
    ...more,
  });
}
