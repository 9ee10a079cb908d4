#ifndef STRIBECK_H
#define STRIBECK_H

/* Generated from the crate in c/ by `STRIBECK_BLESS=1 cargo test -p stribeck-c`. */

#include <stddef.h>
#include <stdint.h>

/**
 * Version of this interface: a program and a library belong together where `stribeck_version()`
 * returns it.
 */
#define STRIBECK_VERSION 1

/**
 * How a call went.
 */
typedef enum {
  /**
   * As it should.
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
   * The model names a law or an effect that is unknown, twice there or in the law already.
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
   * A constant is unknown or cannot have this value.
   */
  STRIBECK_STATUS_CONSTANT = 6,
  /**
   * The period or a limit is not a positive number.
   */
  STRIBECK_STATUS_LIMIT = 7,
} stribeck_status;

/**
 * Where a torque comes from.
 */
typedef enum {
  /**
   * From the model.
   */
  STRIBECK_SOURCE_LAW = 0,
  /**
   * From the model, which gives more than the limit.
   */
  STRIBECK_SOURCE_LIMIT = 1,
  /**
   * From the last reading that could be used.
   */
  STRIBECK_SOURCE_LAST = 2,
  /**
   * From nowhere: there is nothing to go by, the torque is 0.
   */
  STRIBECK_SOURCE_NONE = 3,
} stribeck_source;

/**
 * Friction of one joint with its state: room that the caller owns. Its contents may change from
 * version to version.
 */
typedef struct {
  uint64_t tag;
  uint64_t words[384];
} stribeck_joint_f64;

/**
 * A constant of a model, by its name.
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
 * What a joint is made from. Pointers are read by the function that makes a joint alone.
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
   * How many parameters.
   */
  size_t parameter_count;
  /**
   * Constants that are not the usual ones; may be null.
   */
  const stribeck_constant *constants;
  /**
   * How many constants.
   */
  size_t constant_count;
  /**
   * Sample period (s).
   */
  double period;
  /**
   * Largest torque that is given (N m or N).
   */
  double torque_limit;
  /**
   * Largest speed that the joint can have: a reading beyond it is not believed.
   */
  double speed_limit;
  /**
   * For how many samples in a row without a reading the last torque is given.
   */
  uint32_t held;
} stribeck_settings_f64;

/**
 * What is read at one instant, in SI units. Channels that the model does not read: 0.
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
   * Load torque: all at the joint that is not friction (N m or N).
   */
  double load_torque;
  /**
   * Second derivative of the load torque by time (N m/s2 or N/s2).
   */
  double load_torque_curvature;
  /**
   * Motor torque (N m or N).
   */
  double motor_torque;
  /**
   * Torque of the environment on the joint, without inertia (N m or N).
   */
  double external_torque;
  /**
   * Time since the start (s).
   */
  double time;
} stribeck_sample_f64;

/**
 * Friction of one joint with its state: room that the caller owns. Its contents may change from
 * version to version.
 */
typedef struct {
  uint64_t tag;
  uint64_t words[256];
} stribeck_joint_f32;

/**
 * What a joint is made from. Pointers are read by the function that makes a joint alone.
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
   * How many parameters.
   */
  size_t parameter_count;
  /**
   * Constants that are not the usual ones; may be null.
   */
  const stribeck_constant *constants;
  /**
   * How many constants.
   */
  size_t constant_count;
  /**
   * Sample period (s).
   */
  float period;
  /**
   * Largest torque that is given (N m or N).
   */
  float torque_limit;
  /**
   * Largest speed that the joint can have: a reading beyond it is not believed.
   */
  float speed_limit;
  /**
   * For how many samples in a row without a reading the last torque is given.
   */
  uint32_t held;
} stribeck_settings_f32;

/**
 * What is read at one instant, in SI units. Channels that the model does not read: 0.
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
   * Load torque: all at the joint that is not friction (N m or N).
   */
  float load_torque;
  /**
   * Second derivative of the load torque by time (N m/s2 or N/s2).
   */
  float load_torque_curvature;
  /**
   * Motor torque (N m or N).
   */
  float motor_torque;
  /**
   * Torque of the environment on the joint, without inertia (N m or N).
   */
  float external_torque;
  /**
   * Time since the start (s).
   */
  float time;
} stribeck_sample_f32;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * Makes a joint of which nothing has been read yet.
 *
 * # Safety
 * The pointers are null or point to what their types say, `parameters` and `constants` to as many
 * elements as the counts say, strings end in 0.
 */
stribeck_status stribeck_joint_init_f64(stribeck_joint_f64 *joint,
                                        const stribeck_settings_f64 *settings);

/**
 * The torque to add until the next sample. A null `sample` is a reading that has not come; one that
 * is not finite, or too fast, counts as that. `source` may be null.
 *
 * # Safety
 * The pointers are null or point to what their types say.
 */
stribeck_status stribeck_joint_next_f64(stribeck_joint_f64 *joint,
                                        const stribeck_sample_f64 *sample,
                                        double *torque,
                                        stribeck_source *source);

/**
 * Makes a joint of which nothing has been read yet.
 *
 * # Safety
 * The pointers are null or point to what their types say, `parameters` and `constants` to as many
 * elements as the counts say, strings end in 0.
 */
stribeck_status stribeck_joint_init_f32(stribeck_joint_f32 *joint,
                                        const stribeck_settings_f32 *settings);

/**
 * The torque to add until the next sample. A null `sample` is a reading that has not come; one that
 * is not finite, or too fast, counts as that. `source` may be null.
 *
 * # Safety
 * The pointers are null or point to what their types say.
 */
stribeck_status stribeck_joint_next_f32(stribeck_joint_f32 *joint,
                                        const stribeck_sample_f32 *sample,
                                        float *torque,
                                        stribeck_source *source);

/**
 * The version that the library has.
 */
uint32_t stribeck_version(void);

/**
 * How many parameters a model has.
 *
 * # Safety
 * The pointers are null or point to what their types say; the string ends in 0.
 */
stribeck_status stribeck_parameter_count(const char *model, size_t *count);

/**
 * What a status means, in English. Any number may be given: C does not check what is in an enum.
 */
const char *stribeck_message(int32_t status);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* STRIBECK_H */
