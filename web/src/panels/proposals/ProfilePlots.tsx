import type { AxisProfile, Motor } from "../../api/client";
import { useConsole } from "../../state/store";
import { type Curve, curvesOf, HEIGHT, type Profile, WIDTH } from "./profile";

/** How each axis will go, beside what it may do. */
export function ProfilePlots({ profile }: { readonly profile: Profile }) {
  const motors = useConsole((state) => state.motors);
  if (profile.basis === "none") return <p className="plan-words">Nothing to plot. {profile.why}</p>;
  return (
    <>
      <ul className="profiles">
        {profile.axes.map((axis) => {
          const motor = motors.find(({ slot }) => slot === axis.slot);
          return motor && <AxisCurves key={axis.slot} profile={profile} axis={axis} motor={motor} />;
        })}
      </ul>
      <p className="plan-words profile-key">
        <span className="key-plan">━ planned</span>
        <span className="key-band">▒ where the kernel takes setpoints</span>
        <span className="key-limit">
          ╌ {profile.basis === "time" ? "soft and velocity limits" : "bound of the drive"}
        </span>
        {profile.basis === "way" &&
          "A move of one axis has no plan in time: its drive follows the way that is left."}
      </p>
    </>
  );
}

interface AxisCurvesProps {
  readonly profile: Profile;
  readonly axis: AxisProfile;
  readonly motor: Motor;
}

function AxisCurves({ profile, axis, motor }: AxisCurvesProps) {
  return (
    <li className="profile-axis">
      <h4>{motor.title}</h4>
      {curvesOf(profile, axis, motor).map((curve) => (
        <CurveFigure key={curve.title} name={`${curve.title} of ${motor.title}`} curve={curve} />
      ))}
    </li>
  );
}

function CurveFigure({ name, curve }: { readonly name: string; readonly curve: Curve }) {
  return (
    <figure className="profile-figure" data-within={curve.within}>
      <figcaption>
        {curve.title}: {curve.words}
        {!curve.within && <strong className="beyond"> ▲ beyond its limits</strong>}
      </figcaption>
      <svg
        viewBox={`0 0 ${WIDTH} ${HEIGHT}`}
        preserveAspectRatio="none"
        role="img"
        aria-label={`${name}: ${curve.words}${curve.within ? "" : "; beyond its limits"}`}
      >
        <Band curve={curve} />
        {curve.limits.map((height) => (
          <line key={height} className="profile-limit" x1="0" x2={WIDTH} y1={height} y2={height} />
        ))}
        <polyline className="profile-line" points={curve.points} />
      </svg>
      <div className="profile-ends">
        {curve.ends.map((end, index) => (
          <span key={index === 0 ? "first" : "last"}>{end}</span>
        ))}
      </div>
    </figure>
  );
}

function Band({ curve: { band, overWay } }: { readonly curve: Curve }) {
  if (band === null) return null;
  const [begin, end] = band;
  const long = Math.max(0, end - begin);
  return overWay ? (
    <rect className="profile-band" x={begin} width={long} y="0" height={HEIGHT} />
  ) : (
    <rect className="profile-band" x="0" width={WIDTH} y={begin} height={long} />
  );
}
