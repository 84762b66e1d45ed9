/** The page's state as plain data, for `window.mapless`. */

import type { HeightField } from '../ground/heightField.ts';
import { type Frame, isDisturbed, type SessionInfo } from '../protocol/simulationProtocol.ts';
import type { MaplessState } from './windowApi.ts';

export function stateOf(
  info: SessionInfo,
  frame: Frame,
  field: HeightField,
  playing: boolean,
  speed: number,
): MaplessState {
  const {
    buffers: _buffers,
    trail: _trail,
    rows: _rows,
    movers: _movers,
    anew: _anew,
    ahead: _ahead,
    path: _path,
    sensor: _sensor,
    segments,
    subgoals,
    stop_reason: stopReason,
    set_aside: setAside,
    mount_misfit: mountMisfit,
    waypoints_passed: waypointsPassed,
    ...rest
  } = frame;
  return {
    ...rest,
    stopReason,
    setAside,
    mountMisfit,
    waypointsPassed,
    scenario: info.scenario,
    preset: info.preset,
    learning: info.learning,
    seed: info.seed,
    start: info.start,
    waypoints: info.waypoints,
    goal: info.goal,
    objects: info.objects,
    overrides: info.overrides,
    reality: info.reality,
    playing,
    speed,
    ground: { columns: field.columns, rows: field.rows, cell_m: field.cell_m },
    segments: segments.length,
    subgoals: subgoals.length,
    disturbed: isDisturbed(frame.timeline),
  };
}
