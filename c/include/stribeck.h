#ifndef STRIBECK_H
#define STRIBECK_H

/* Generated from the crate in c/ by `STRIBECK_BLESS=1 cargo test -p stribeck-c`. */

#include <stddef.h>
#include <stdint.h>

/**
 * Version of this interface: a program is compatible with a library for which `stribeck_version()`
 * returns the same value.
 */
#define STRIBECK_VERSION 1

/**
 * The result of a call.
 */
typedef enum {
  /**
   * Success.
   */
  STRIBECK_STATUS_OK = 0,
  /**
   * A pointer is null.
   */
  STRIBECK_STATUS_NULL_POINTER = 1,
  /**
   * The joint has not been initialised.
   */
  STRIBECK_STATUS_NOT_INITIALISED = 2,
  /**
   * The model contains an unknown law or effect, or an effect that is named twice or part of the
   * law.
   */
  STRIBECK_STATUS_UNKNOWN_MODEL = 3,
  /**
   * The number of parameters is not that of the model.
   */
  STRIBECK_STATUS_PARAMETER_COUNT = 4,
  /**
   * The model cannot be evaluated with one of the parameters.
   */
  STRIBECK_STATUS_PARAMETER_VALUE = 5,
  /**
   * A constant is unknown, or its value is inadmissible.
   */
  STRIBECK_STATUS_CONSTANT = 6,
  /**
   * The period or a limit is not a positive number.
   */
  STRIBECK_STATUS_LIMIT = 7,
} stribeck_status;

/**
 * The origin of a torque.
 */
typedef enum {
  /**
   * The model.
   */
  STRIBECK_SOURCE_LAW = 0,
  /**
   * The model, limited.
   */
  STRIBECK_SOURCE_LIMIT = 1,
  /**
   * The last valid reading.
   */
  STRIBECK_SOURCE_LAST = 2,
  /**
   * None: no valid reading is recent enough; the torque is 0.
   */
  STRIBECK_SOURCE_NONE = 3,
} stribeck_source;

/**
 * Friction of one joint with its state, in memory that the caller owns. The layout may change
 * between versions.
 */
typedef struct {
  uint64_t tag;
  uint64_t words[384];
} stribeck_joint_f64;

/**
 * A constant of a model.
 */
typedef struct {
  /**
   * Name, as in a model file.
   */
  const char *name;
  /**
   * Value.
   */
  double value;
} stribeck_constant;

/**
 * Settings of a joint. The pointers are read only by the function that initialises it.
 */
typedef struct {
  /**
   * Law and effects, as in a model file: `"lugre+load"`.
   */
  const char *model;
  /**
   * Parameters in the order of the model file.
   */
  const double *parameters;
  /**
   * Number of parameters.
   */
  size_t parameter_count;
  /**
   * Constants that differ from their defaults; may be null.
   */
  const stribeck_constant *constants;
  /**
   * Number of constants.
   */
  size_t constant_count;
  /**
   * Sample period (s).
   */
  double period;
  /**
   * Largest torque (N m or N).
   */
  double torque_limit;
  /**
   * Largest speed of the joint: a reading above it is invalid.
   */
  double speed_limit;
  /**
   * Number of consecutive missing or invalid readings for which the last torque is held.
   */
  uint32_t held;
} stribeck_settings_f64;

/**
 * The inputs at one instant, in SI units. Channels that the model does not read are 0.
 */
typedef struct {
  /**
   * Velocity (rad/s or m/s).
   */
  double velocity;
  /**
   * Position (rad or m).
   */
  double position;
  /**
   * Acceleration (rad/s2 or m/s2).
   */
  double acceleration;
  /**
   * Joint temperature (degC).
   */
  double temperature;
  /**
   * Load torque: all torque at the joint except friction (N m or N).
   */
  double load_torque;
  /**
   * Second time derivative of the load torque (N m/s2 or N/s2); behind a resonance that of the
   * torque in the spring.
   */
  double load_torque_curvature;
  /**
   * Motor torque (N m or N).
   */
  double motor_torque;
  /**
   * External torque of the environment on the joint, without inertia (N m or N).
   */
  double external_torque;
  /**
   * Time since the start (s).
   */
  double time;
  /**
   * Time derivative of the temperature (K/s).
   */
  double temperature_rate;
} stribeck_sample_f64;

/**
 * Friction of one joint with its state, in memory that the caller owns. The layout may change
 * between versions.
 */
typedef struct {
  uint64_t tag;
  uint64_t words[256];
} stribeck_joint_f32;

/**
 * Settings of a joint. The pointers are read only by the function that initialises it.
 */
typedef struct {
  /**
   * Law and effects, as in a model file: `"lugre+load"`.
   */
  const char *model;
  /**
   * Parameters in the order of the model file.
   */
  const float *parameters;
  /**
   * Number of parameters.
   */
  size_t parameter_count;
  /**
   * Constants that differ from their defaults; may be null.
   */
  const stribeck_constant *constants;
  /**
   * Number of constants.
   */
  size_t constant_count;
  /**
   * Sample period (s).
   */
  float period;
  /**
   * Largest torque (N m or N).
   */
  float torque_limit;
  /**
   * Largest speed of the joint: a reading above it is invalid.
   */
  float speed_limit;
  /**
   * Number of consecutive missing or invalid readings for which the last torque is held.
   */
  uint32_t held;
} stribeck_settings_f32;

/**
 * The inputs at one instant, in SI units. Channels that the model does not read are 0.
 */
typedef struct {
  /**
   * Velocity (rad/s or m/s).
   */
  float velocity;
  /**
   * Position (rad or m).
   */
  float position;
  /**
   * Acceleration (rad/s2 or m/s2).
   */
  float acceleration;
  /**
   * Joint temperature (degC).
   */
  float temperature;
  /**
   * Load torque: all torque at the joint except friction (N m or N).
   */
  float load_torque;
  /**
   * Second time derivative of the load torque (N m/s2 or N/s2); behind a resonance that of the
   * torque in the spring.
   */
  float load_torque_curvature;
  /**
   * Motor torque (N m or N).
   */
  float motor_torque;
  /**
   * External torque of the environment on the joint, without inertia (N m or N).
   */
  float external_torque;
  /**
   * Time since the start (s).
   */
  float time;
  /**
   * Time derivative of the temperature (K/s).
   */
  float temperature_rate;
} stribeck_sample_f32;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * Initialises a joint without readings.
 *
 * # Safety
 * Every pointer is null or points to what its type says, `parameters` and `constants` to as many
 * elements as the counts say; strings end in 0.
 */
stribeck_status stribeck_joint_init_f64(stribeck_joint_f64 *joint,
                                        const stribeck_settings_f64 *settings);

/**
 * The torque to add until the next sample. A null `sample` is a missing reading; one that is not
 * finite or too fast counts as missing. `source` may be null.
 *
 * # Safety
 * Every pointer is null or points to what its type says.
 */
stribeck_status stribeck_joint_next_f64(stribeck_joint_f64 *joint,
                                        const stribeck_sample_f64 *sample,
                                        double *torque,
                                        stribeck_source *source);

/**
 * Initialises a joint without readings.
 *
 * # Safety
 * Every pointer is null or points to what its type says, `parameters` and `constants` to as many
 * elements as the counts say; strings end in 0.
 */
stribeck_status stribeck_joint_init_f32(stribeck_joint_f32 *joint,
                                        const stribeck_settings_f32 *settings);

/**
 * The torque to add until the next sample. A null `sample` is a missing reading; one that is not
 * finite or too fast counts as missing. `source` may be null.
 *
 * # Safety
 * Every pointer is null or points to what its type says.
 */
stribeck_status stribeck_joint_next_f32(stribeck_joint_f32 *joint,
                                        const stribeck_sample_f32 *sample,
                                        float *torque,
                                        stribeck_source *source);

/**
 * The version of the library.
 */
uint32_t stribeck_version(void);

/**
 * Number of parameters of a model.
 *
 * # Safety
 * Every pointer is null or points to what its type says; the string ends in 0.
 */
stribeck_status stribeck_parameter_count(const char *model, size_t *count);

/**
 * The message of a status. Any number may be passed: C does not check the values of an enum.
 */
const char *stribeck_message(int32_t status);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* STRIBECK_H */
