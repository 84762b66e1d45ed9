/** Shaders of the ground. Lines are drawn in the fragment shader, so they lie on the ground at any zoom. */

export const VERTEX = /* glsl */ `
attribute vec2 side;
uniform highp sampler2D heights;
uniform float cell;
uniform vec2 size;
uniform float base;
uniform int reach;
varying float slopeOut;
varying vec3 place;
varying vec3 normalOut;
varying vec2 grid;
flat varying float cut;

float heightAt(ivec2 sample_) {
  return texelFetch(heights, clamp(sample_, ivec2(0), ivec2(size) - 1), 0).r;
}

void main() {
  ivec2 here = ivec2(position.xy + 0.5);
  float height = heightAt(here);
  vec2 slope = vec2(
    heightAt(here + ivec2(1, 0)) - heightAt(here - ivec2(1, 0)),
    heightAt(here + ivec2(0, 1)) - heightAt(here - ivec2(0, 1))
  ) / (2.0 * cell);
  vec2 underRobot = vec2(
    heightAt(here + ivec2(reach, 0)) - heightAt(here - ivec2(reach, 0)),
    heightAt(here + ivec2(0, reach)) - heightAt(here - ivec2(0, reach))
  ) / (2.0 * float(reach) * cell);
  slopeOut = atan(length(underRobot));
  cut = abs(side.x) + abs(side.y);
  normalOut = cut > 0.5 ? vec3(side, 0.0) : normalize(vec3(-slope, 1.0));
  place = vec3(position.xy * cell, position.z > 0.5 ? base : height);
  grid = (position.xy + 0.5) / size;
  gl_Position = projectionMatrix * viewMatrix * vec4(place, 1.0);
}
`;

export const FRAGMENT = /* glsl */ `
varying float slopeOut;
varying vec3 place;
varying vec3 normalOut;
varying vec2 grid;
flat varying float cut;
uniform int colouring;
uniform float steepest;
uniform vec2 limits;
uniform vec3 slopeColours[5];
uniform vec3 standColours[3];
uniform sampler2D light;
uniform vec2 range;
uniform vec3 sun;
uniform vec3 relief[5];
uniform vec3 rock;
uniform vec4 contour;
uniform vec4 robot;
uniform float ringRadius;
uniform vec3 ringColour;
uniform vec4 brush;
uniform float brushRadius;
uniform vec3 brushColour;

vec3 elevationColour(float t) {
  float step_ = clamp(t, 0.0, 1.0) * 4.0;
  int index = int(min(floor(step_), 3.0));
  return mix(relief[index], relief[index + 1], step_ - float(index));
}

vec3 slopeColour(float t) {
  float step_ = clamp(t, 0.0, 1.0) * 4.0;
  int index = int(min(floor(step_), 3.0));
  return mix(slopeColours[index], slopeColours[index + 1], step_ - float(index));
}

/** Safe at any heading, at some, at none; the last is striped, for those who see no difference in colour. */
vec3 standColour(float slope) {
  float soft = 0.5 * fwidth(slope) + 1e-4;
  vec3 colour_ = mix(standColours[0], standColours[1], smoothstep(limits.x - soft, limits.x + soft, slope));
  float never = smoothstep(limits.y - soft, limits.y + soft, slope);
  float stripe = step(0.5, fract((place.x + place.y) / 0.5));
  return mix(colour_, standColours[2] * (1.0 - 0.28 * stripe), never);
}

/** Coverage of a line of the given width in pixels where value is zero. */
float line(float value, float width) {
  float pixel = max(fwidth(value), 1e-6);
  return 1.0 - smoothstep(0.5 * width - 0.5, 0.5 * width + 0.5, abs(value) / pixel);
}

/** Contour lines every interval metres, fading where they would run together. */
float contours(float interval, float width) {
  float value = place.z / interval;
  float pixel = fwidth(value);
  float nearest = value - floor(value + 0.5);
  float cover = 1.0 - smoothstep(0.5 * width - 0.5, 0.5 * width + 0.5, abs(nearest) / max(pixel, 1e-6));
  return cover * (1.0 - smoothstep(0.18, 0.45, pixel));
}

void main() {
  vec3 normal = normalize(normalOut);
  vec3 ground = elevationColour((place.z - range.x) / (range.y - range.x));
  float steep = acos(clamp(normal.z, 0.0, 1.0));
  ground = mix(ground, rock, 0.75 * smoothstep(0.40, 0.72, steep) * (1.0 - cut));
  if (colouring == 1) ground = mix(slopeColour(slopeOut / steepest), ground, cut);
  if (colouring == 2) ground = mix(standColour(slopeOut), ground, cut);

  float open = texture(light, grid).r;
  float facing = max(dot(normal, sun), 0.0);
  float shade = cut > 0.5 ? 0.36 + 0.12 * facing : 0.26 * open + 0.98 * facing * open + 0.10 * normal.z;
  vec3 shaded = ground * shade;

  float lines = max(0.55 * contours(0.25, 1.0), contours(1.0, 1.3));
  shaded = mix(shaded, contour.rgb, contour.a * lines);

  if (cut < 0.5) {
    vec2 away = place.xy - robot.xy;
    float distance_ = length(away);
    vec2 body = vec2(dot(away, robot.zw), dot(away, vec2(-robot.w, robot.z)));
    vec2 outside = max(abs(body) - vec2(0.42, 0.30), 0.0);
    float under = 1.0 - smoothstep(0.0, 0.34, length(outside));
    shaded *= 1.0 - 0.62 * under;
    if (ringRadius > 0.0) {
      shaded *= 1.0 + 0.13 * (1.0 - smoothstep(ringRadius - 0.05, ringRadius, distance_));
      float dash = step(0.36, fract(atan(away.y, away.x) * 60.0 / 6.2831853));
      shaded = mix(shaded, ringColour, 0.62 * dash * line(distance_ - ringRadius, 2.0));
    }
    if (brushRadius > 0.0) {
      vec2 along = brush.zw - brush.xy;
      vec2 out_ = place.xy - brush.xy;
      float share = clamp(dot(out_, along) / max(dot(along, along), 1e-6), 0.0, 1.0);
      float from = length(out_ - share * along);
      shaded = mix(shaded, brushColour, 0.16 * (1.0 - smoothstep(0.0, brushRadius, from)));
      shaded = mix(shaded, brushColour, line(from - brushRadius, 2.4));
    }
  }
  gl_FragColor = linearToOutputTexel(vec4(shaded, 1.0));
}
`;
